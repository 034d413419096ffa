/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/kernel.h"

#include <stdlib.h>
#include <string.h>

#ifdef __x86_64__
extern const struct kernel kernel_x86_64, kernel_x86_64_v3, kernel_x86_64_v4;

const struct kernel *kernel_select(void) {
  /* DEM_ISA=x86_64 or x86_64_v3 asks for less than the machine has, for tests
     and benchmarks. */
  const char *most = getenv("DEM_ISA");
  if (most && !strcmp(most, kernel_x86_64.name))
    return &kernel_x86_64;
  if (most && !strcmp(most, kernel_x86_64_v3.name))
    most = "";
  else
    most = NULL;
  __builtin_cpu_init();
  if (!most && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return &kernel_x86_64_v4;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return &kernel_x86_64_v3;
  return &kernel_x86_64;
}
#else
extern const struct kernel kernel_native;

const struct kernel *kernel_select(void) {
  return &kernel_native;
}
#endif
