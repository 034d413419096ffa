# clang (Debian clang version 14.0.6)  -O3 -g 
KERNELS := x86_64 x86_64_v3 x86_64_v4
MARCH_x86_64 := -march=x86-64
MARCH_x86_64_v3 := -march=x86-64-v3
MARCH_x86_64_v4 := -march=x86-64-v4 -mprefer-vector-width=512
LIBMVEC := -lmvec
VECLIB := -fveclib=libmvec
FOUND_QUIET := -Wno-psabi -Wno-pass-failed -Wno-string-conversion
FOUND_OPENMP := -fopenmp
FOUND_SIMD := -fopenmp-simd
FOUND_GSL_CFLAGS := 
FOUND_GSL_LIBS := -lgsl -lgslcblas -lm 
