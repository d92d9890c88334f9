# The sets of instructions that loops (src/shading/dialect/loop.h) are compiled for: all, so that `--isa` has a choice and tests
# see each, or one, since loops for three take most of a build's time. A build with tests, and one
# that is to run on other machines (WEFT_ARCH none), has all unless told otherwise.
set(WEFT_ISA "" CACHE STRING
  "Sets of instructions of loops: all, auto (the widest that this machine runs), sse2, avx2 or avx512; empty: all with tests or for any machine, else auto")
set(weft_isa ${WEFT_ISA})
if(NOT weft_isa AND (WEFT_TESTS OR WEFT_ARCH STREQUAL "none") OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(weft_isa all)
elseif(NOT weft_isa)
  set(weft_isa auto)
endif()
if(weft_isa STREQUAL "auto")
  include(CheckCSourceRuns)
  set(weft_isa sse2)
  check_c_source_runs("int main(void) {
    return !(__builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") && __builtin_cpu_supports(\"bmi\") &&
      __builtin_cpu_supports(\"bmi2\")); }" WEFT_RUNS_AVX2)
  check_c_source_runs("int main(void) {
    return !(__builtin_cpu_supports(\"avx512f\") && __builtin_cpu_supports(\"avx512bw\") && __builtin_cpu_supports(\"avx512cd\") &&
      __builtin_cpu_supports(\"avx512dq\") && __builtin_cpu_supports(\"avx512vl\")); }" WEFT_RUNS_AVX512)
  if(WEFT_RUNS_AVX2)
    set(weft_isa avx2)
    if(WEFT_RUNS_AVX512)
      set(weft_isa avx512)
    endif()
  endif()
endif()
if(NOT weft_isa MATCHES "^(all|sse2|avx2|avx512)$")
  message(FATAL_ERROR "WEFT_ISA is ${WEFT_ISA}, not all, auto, sse2, avx2 or avx512")
endif()
