#include "shading/kind.h"

#define K(name) extern const StackKind kind_##name;
#include "shading/kinds.gen.h"
#undef K

#define K(name) &kind_##name,
static const StackKind any = {NULL, stack_make, stack_see, stack_eval, stack_sample};
static const StackKind *const kinds[] = {
#include "shading/kinds.gen.h"
    &any};

const StackKind *stack_kind(const Stack *plain, const Choices *choices) {
    const StackKind *const *kind = kinds;
    while (*kind != &any && (!plain || !(*kind)->fits(plain, choices))) kind++;
    return *kind;
}
