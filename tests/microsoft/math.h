/* math.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#define HUGE_VAL ((double)(1e300 * 1e300))
#define INFINITY ((float)(1e300 * 1e300))
#define NAN (-(float)(INFINITY * 0.0f))
#define isfinite(x) (((x) - (x)) == 0)
#define isnan(x) ((x) != (x))
#define signbit(x) (_copysign(1.0, (x)) < 0)
#ifdef __cplusplus
extern "C" {
#endif
double acos(double), asin(double), atan(double), atan2(double, double), ceil(double), cos(double), exp(double);
double fabs(double), floor(double), fmax(double, double), fmin(double, double), fmod(double, double),
    frexp(double, int *);
double hypot(double, double), ldexp(double, int), log(double), log10(double), log2(double), nextafter(double, double);
double pow(double, double), rint(double), round(double), sin(double), sqrt(double), tan(double),
    _copysign(double, double);
double cbrt(double), log1p(double);
#ifdef __cplusplus
}
#endif
