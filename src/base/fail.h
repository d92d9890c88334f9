/* fail.h - construction of the errors and warnings of weft/result.h */
#pragma once

#include "weft/result.h"

/* Fills *error (may be NULL) with "subject: text" or, where detail is a printf format and not NULL,
 * "subject: text: detail", and returns the message's result: `return fail(error, WEFT_MESSAGE_X, path,
 * NULL);`. Characters that a terminal obeys become '?', so that a hostile name cannot break it. */
__attribute__((format(printf, 4, 5))) WeftResult fail(WeftError *error, WeftMessage message, const char *subject,
                                                      const char *detail, ...);

/* Returns the result that fail returns for a message. */
WeftResult message_result(WeftMessage message);

/* Hands the same line to the log as a warning. log may be NULL. */
__attribute__((format(printf, 4, 5))) void warn(const WeftLog *log, WeftMessage message, const char *subject,
                                                const char *detail, ...);
