/* crash.h - the last words of a program that crashes */
#pragma once

/* Makes a crash, such as a fault in a driver, say one line and the addresses of the calls that led to it, for a report.
 * The program still ends by the signal. A handler that is there already, as a sanitizer's, stays. */
void crash_begin(void);
