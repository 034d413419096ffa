/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "dynamics/kernel.h"

#include <stdlib.h>
#include <string.h>

#ifdef __x86_64__
#include <cpuid.h>

extern const struct kernel kernel_x86_64, kernel_x86_64_v3, kernel_x86_64_v4;

#define HAS(feature) (__builtin_cpu_supports(feature) != 0)

/* Not every compiler's builtin knows these three. */
static bool machine_has_movbe_f16c_lzcnt(void) {
  unsigned a, b, c, d;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_MOVBE) || !(c & bit_F16C))
    return false;
  return __get_cpuid(0x80000001, &a, &b, &c, &d) && (c & bit_LZCNT);
}

/* All that a compiler may emit for -march=x86-64-v3, and that the operating
   system keeps the registers of. */
static bool machine_has_v3(void) {
  return HAS("sse4.2") && HAS("popcnt") && HAS("avx") && HAS("avx2") &&
         HAS("fma") && HAS("bmi") && HAS("bmi2") &&
         machine_has_movbe_f16c_lzcnt();
}

/* The same for x86-64-v4. */
static bool machine_has_v4(void) {
  return machine_has_v3() && HAS("avx512f") && HAS("avx512bw") &&
         HAS("avx512cd") && HAS("avx512dq") && HAS("avx512vl");
}

const char *const kernel_names[] = {"x86_64", "x86_64_v3", "x86_64_v4", NULL};

const struct kernel *kernel_select(const char *name) {
  const struct kernel *const all[] = {&kernel_x86_64, &kernel_x86_64_v3,
                                      &kernel_x86_64_v4};
  __builtin_cpu_init();
  const size_t count = machine_has_v4() ? 3 : machine_has_v3() ? 2 : 1;
  const char *less = getenv("DEM_ISA");
  for (size_t k = 0; k < count; k++)
    if (!strcmp(all[k]->name, name ? name : less ? less : ""))
      return all[k];
  return name ? NULL : all[count - 1];
}
#else
extern const struct kernel kernel_native;

const char *const kernel_names[] = {"native", NULL};

const struct kernel *kernel_select(const char *name) {
  return !name || !strcmp(name, kernel_native.name) ? &kernel_native : NULL;
}
#endif
