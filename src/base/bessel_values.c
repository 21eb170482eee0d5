/* J0 from the series of special_functions.f90. The compiler makes a version for each width of
   registers; which one is called is decided when the program starts. */
#include <math.h>

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__has_attribute)
#if __has_attribute(target_clones)
#define FOR_EACH_WIDTH __attribute__((target_clones("avx512f", "fma", "default")))
#endif
#endif
#ifndef FOR_EACH_WIDTH
#define FOR_EACH_WIDTH
#endif

/* Degrees of the series, as in special_functions.f90. */
enum { DEGREE_NEAR = 14, DEGREE_FAR = 8, DEGREE_COSINE = 7 };

static inline double power_series(int degree, const double *coefficient, double x) {
  double sum = coefficient[degree];
  for (int j = degree - 1; j >= 0; j--)
    sum = sum * x + coefficient[j];
  return sum;
}

FOR_EACH_WIDTH
void snapin_j0_near(int count, const double *restrict x, double *restrict value, double near,
                    const double *series) {
  for (int i = 0; i < count; i++)
    value[i] = power_series(DEGREE_NEAR, series, 2 * (x[i] / near) * (x[i] / near) - 1);
}

/* Adding the rounder to a number and subtracting it again rounds the number. pi is the sum of two
   parts, the first of which has so few digits that its multiples by integers are exact. */
FOR_EACH_WIDTH
void snapin_j0_far(int count, const double *restrict x, double *restrict value, double near,
                   const double *amplitude, const double *lag, const double *cosine) {
  const double pi = 3.14159265358979324, pi_first = 3.140625, pi_rest = 9.67653589793115998e-4;
  const double rounder = 6755399441055744.0;
  for (int i = 0; i < count; i++) {
    double inverse = 1 / x[i];
    double at = 2 * (near * inverse) * (near * inverse) - 1;
    double phase = -pi / 4 - power_series(DEGREE_FAR, lag, at) * inverse;
    double size = power_series(DEGREE_FAR, amplitude, at) * sqrt(2 / pi * inverse);
    /* The cosine of the difference between x + phase and the nearest multiple of pi. */
    double turns = ((x[i] + phase) * (1 / pi) + rounder) - rounder;
    double rest = ((x[i] - turns * pi_first) - turns * pi_rest) + phase;
    double value_of = size * power_series(DEGREE_COSINE, cosine,
                                          2 * (rest * (2 / pi)) * (rest * (2 / pi)) - 1);
    /* Odd multiples change the sign: the multiple modulo 2 is 0, 1 or -1. */
    turns -= 2 * ((0.5 * turns + rounder) - rounder);
    value[i] = value_of * (1 - 2 * turns * turns);
  }
}
