/* test_number.c - >>number: reading and writing decimal numbers, against the C library and on hard cases; >>stream: numbers in
   bytes. */
#define GPROJ_STATIC
#include "gprojt.h"

#include <locale.h>

static uint64_t gprojt_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double gprojt_of_bits(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static double gprojt_read(const char *text) {
    double value = 12345.678;
    size_t used = gproj_number_read(text, strlen(text), &value);
    GPROJT_CHECK(used == strlen(text));
    return value;
}

/* The library and strtod give the same bits. */
static void gprojt_same_as_strtod(const char *text) {
    double mine = gprojt_read(text), theirs = strtod(text, NULL);
    if (gprojt_bits(mine) != gprojt_bits(theirs)) {
        printf("  \"%s\": %.17g, strtod %.17g\n", text, mine, theirs);
        gprojt_fail(__FILE__, __LINE__, "same bits as strtod");
    }
}

GPROJT_TEST(read_hard_cases) {
    static const char *const texts[] = {"0",
                                        "-0",
                                        "+0",
                                        "0.0",
                                        "-0.0e5",
                                        "1",
                                        "-1",
                                        "+1",
                                        ".5",
                                        "5.",
                                        "-.5e1",
                                        "1e0",
                                        "1E5",
                                        "1e+5",
                                        "1e-5",
                                        "00012.500",
                                        "0.1",
                                        "0.2",
                                        "0.3",
                                        "123456789012345678",
                                        "9007199254740993",
                                        "9007199254740992",
                                        "9007199254740991",
                                        "9007199254740993.00000000000000000000000000000000000000001",
                                        "9007199254740992.99999999999999999999999999",
                                        "1.7976931348623157e308",
                                        "1.7976931348623158e308",
                                        "1.7976931348623159e308",
                                        "1.797693134862315808e308",
                                        "179769313486231580793728971405301e276",
                                        "1e309",
                                        "-1e400",
                                        "1e999999999999999999999999",
                                        "1e-999999999999999999999",
                                        "0e999999999999999999",
                                        "4.9406564584124654e-324",
                                        "5e-324",
                                        "2.4703282292062327e-324",
                                        "2.4703282292062328e-324",
                                        "2.47e-324",
                                        "3e-324",
                                        "1e-400",
                                        "2.2250738585072011e-308",
                                        "2.2250738585072012e-308",
                                        "2.2250738585072014e-308",
                                        "2.2250738585072009e-308",
                                        "6.631236846766476e-316",
                                        "3.2378839133029012895883524125015321748630094590e-319",
                                        "1.00000000000000011102230246251565404236316680908203125",
                                        "1.00000000000000011102230246251565404236316680908203124",
                                        "1.00000000000000011102230246251565404236316680908203126",
                                        "0.500000000000000166533453693773481063544750213623046875",
                                        "1448997445238699",
                                        "6.02214076e23",
                                        "1e22",
                                        "1e23",
                                        "8.5e22",
                                        "9.5e-23",
                                        "1e27",
                                        "1e28",
                                        "18446744073709551615e27",
                                        "9999999999999999999e-27",
                                        "9999999999999999999e27",
                                        "1e-27",
                                        "1e-28",
                                        "8.41e21",
                                        "2.0e-28",
                                        "3.5844466002796428e298",
                                        "104110013277974872254e-225",
                                        "7.2057594037927933e16",
                                        "1000000000000000000000000000000000000000000e-42",
                                        "0.000000000000000000000000000000000000000000000000000001e54"};
    char text[2048];
    size_t i;
    for (i = 0; i < sizeof texts / sizeof texts[0]; ++i) gprojt_same_as_strtod(texts[i]);
    /* the midpoint of the two smallest numbers, in full, and a last digit more or less far behind */
    snprintf(text, sizeof text, "%.1100f", 5e-324);
    gprojt_same_as_strtod(text);
    snprintf(text, sizeof text, "%.1075f1", 0x1p-1074);
    gprojt_same_as_strtod(text);
    snprintf(text, sizeof text, "%.1073f", 1.5 * 0x1p-1022);
    gprojt_same_as_strtod(text);
    strcpy(text, "9007199254740993.");
    memset(text + 17, '0', 1500);
    text[1517] = 0;
    gprojt_same_as_strtod(text);
    text[1516] = '1'; /* the 1516th digit decides the tie */
    gprojt_same_as_strtod(text);
    memset(text, '9', 1600);
    text[1600] = 0;
    gprojt_same_as_strtod(text);
    strcpy(text + 1600, "e-1600");
    gprojt_same_as_strtod(text);
}

GPROJT_TEST(read_ties) { /* midpoints of random neighbours, and one digit more */
    uint64_t state = 3;
    int i;
    char text[1200];
    for (i = 0; i < 2000; ++i) {
        int exponent = gprojt_below(&state, 120) - 60;
        long double x = ldexpl((long double)((gprojt_random(&state) >> 11) | 1), exponent); /* 53 bits */
        size_t length;
        if (LDBL_MANT_DIG < 64) break;
        x += ldexpl(0.5L, exponent);
        length = (size_t)snprintf(text, sizeof text, "%.80Lf", x);
        gprojt_same_as_strtod(text);
        text[length] = '1', text[length + 1] = 0;
        gprojt_same_as_strtod(text);
    }
}

GPROJT_TEST(products_of_64_bits) { /* against long multiplication by bits */
    uint64_t seed = 8;
    int i, k;
    for (i = 0; i < 300; ++i) {
        uint64_t a = gprojt_random(&seed) >> (i % 5 * 13), b = gprojt_random(&seed) | 1, low = 0, high = 0, got;
        for (k = 63; k >= 0; --k) {
            high = high << 1 | low >> 63, low <<= 1;
            if (b >> k & 1) low += a, high += low < a;
        }
        GPROJT_CHECK(gproji_multiply_64(a, b, &got) == high && got == low);
    }
}

GPROJT_TEST(read_stops_where_the_number_ends) {
    static const struct {
        const char *text;
        size_t used;
        double value;
    } cases[] = {{"1,5", 1, 1}, {"1e", 1, 1},  {"1e+", 1, 1},   {"2.5.5", 3, 2.5}, {"7x", 1, 7},     {"", 0, 0},
                 {"+", 0, 0},   {"-", 0, 0},   {".", 0, 0},     {"e5", 0, 0},      {"-.e5", 0, 0},   {"- 1", 0, 0},
                 {" 1", 0, 0},  {"--1", 0, 0}, {"0x10", 1, 0},  {"1e5e5", 3, 1e5}, {"3 4", 1, 3},    {"i", 0, 0},
                 {"in", 0, 0},  {"na", 0, 0},  {"5.e1", 4, 50}, {"1d5", 1, 1},     {"12abc", 2, 12}, {"+.5", 3, .5}};
    size_t i;
    for (i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        double value = 0;
        GPROJT_CHECK(gproj_number_read(cases[i].text, strlen(cases[i].text), &value) == cases[i].used);
        GPROJT_CHECK(value == cases[i].value);
    }
    { /* the size bounds the text, not a NUL */
        double value = 0;
        GPROJT_CHECK(gproj_number_read("123456", 3, &value) == 3 && value == 123);
        GPROJT_CHECK(gproj_number_read("1e5", 2, &value) == 1 && value == 1);
        GPROJT_CHECK(gproj_number_read("1e57", 3, &value) == 3 && value == 1e5);
        GPROJT_CHECK(gproj_number_read(NULL, 3, &value) == 0);
        GPROJT_CHECK(gproj_number_read("1", 1, NULL) == 0);
    }
}

GPROJT_TEST(infinity_and_nan) {
    static const char *const infinite[] = {"inf", "INF", "Infinity", "+iNf", "INFINITY"};
    static const char *const nans[] = {"nan", "NaN", "-nan", "+NAN"};
    char text[GPROJ_NUMBER_SIZE];
    double value;
    size_t i;
    for (i = 0; i < 5; ++i) GPROJT_CHECK(gprojt_read(infinite[i]) > 1e308);
    for (i = 0; i < 4; ++i) {
        value = gprojt_read(nans[i]);
        GPROJT_CHECK(value != value);
    }
    GPROJT_CHECK(gprojt_read("-inf") < -1e308);
    GPROJT_CHECK(gproj_number_read("infinit", 7, &value) == 3);
    GPROJT_CHECK(gproj_number_write(HUGE_VAL, text) == 3 && !strcmp(text, "inf"));
    GPROJT_CHECK(gproj_number_write(-HUGE_VAL, text) == 4 && !strcmp(text, "-inf"));
    GPROJT_CHECK(gproj_number_write(gprojt_read("nan"), text) == 3 && !strcmp(text, "nan"));
}

GPROJT_TEST(write_known) {
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0"},
                 {-0.0, "-0"},
                 {1, "1"},
                 {-1, "-1"},
                 {0.1, "0.1"},
                 {0.3, "0.3"},
                 {100, "100"},
                 {1e15, "1000000000000000"},
                 {1e16, "10000000000000000"},
                 {1e17, "1e+17"},
                 {123456789012345680.0, "1.2345678901234568e+17"},
                 {1e22, "1e+22"},
                 {1e23, "1e+23"},
                 {1e-4, "0.0001"},
                 {1e-5, "1e-05"},
                 {-1.5e-7, "-1.5e-07"},
                 {5e-324, "5e-324"},
                 {1.7976931348623157e308, "1.7976931348623157e+308"},
                 {2.2250738585072014e-308, "2.2250738585072014e-308"},
                 {9007199254740993.0, "9007199254740992"},
                 {1.0 / 3, "0.3333333333333333"},
                 {2.0 / 3, "0.6666666666666666"},
                 {0.30000000000000004, "0.30000000000000004"},
                 {123.456, "123.456"},
                 {-0.00012345678901234567, "-0.00012345678901234567"},
                 {9.5, "9.5"},
                 {0x1p-44, "5.684341886080802e-14"},
                 {9.999999999999999e22, "1e+23"},
                 {9.999999999999997e22, "9.999999999999997e+22"},
                 {1.0000000000000001e23, "1.0000000000000001e+23"},
                 {4.35, "4.35"},
                 {0x1p-1022, "2.2250738585072014e-308"},
                 {1.2e-322, "1.2e-322"}};
    char text[GPROJ_NUMBER_SIZE];
    size_t i;
    for (i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        size_t length = gproj_number_write(cases[i].value, text);
        if (strcmp(text, cases[i].text)) printf("  %s instead of %s\n", text, cases[i].text);
        GPROJT_CHECK(!strcmp(text, cases[i].text) && length == strlen(text));
        GPROJT_CHECK(gproj_number_write(cases[i].value, NULL) == length);
    }
}

/* Writing gives the bits back, is as short as the shortest %.*g that does, and reading agrees with strtod. */
static void gprojt_round_trip(double x) {
    char mine[GPROJ_NUMBER_SIZE], theirs[64], digits[64];
    size_t length = gproj_number_write(x, mine), i, count = 0;
    int precision;
    double back;
    GPROJT_CHECK(length < GPROJ_NUMBER_SIZE && length == strlen(mine));
    GPROJT_CHECK(gproj_number_read(mine, length, &back) == length);
    if (gprojt_bits(back) != gprojt_bits(x) || gprojt_bits(strtod(mine, NULL)) != gprojt_bits(x)) {
        printf("  %.17g was written as %s\n", x, mine);
        gprojt_fail(__FILE__, __LINE__, "round trip");
    }
    for (precision = 1; precision <= 17; ++precision) {
        snprintf(theirs, sizeof theirs, "%.*e", precision - 1, x);
        if (strtod(theirs, NULL) == x) break;
    }
    for (i = 0; mine[i] && mine[i] != 'e'; ++i) {
        if (mine[i] >= '0' && mine[i] <= '9' && (count || mine[i] != '0')) digits[count++] = mine[i];
    }
    while (count > 1 && digits[count - 1] == '0') --count;
    GPROJT_CHECK((int)count <= precision);
}

GPROJT_TEST(round_trip_random_bits) {
    uint64_t state = 1;
    int i;
    for (i = 0; i < 30000; ++i) {
        double x = gprojt_of_bits(gprojt_random(&state));
        if (isfinite(x)) gprojt_round_trip(x);
    }
    for (i = 0; i < 30000; ++i) gprojt_round_trip((gprojt_uniform(&state) - 0.5) * 200);
    for (i = -1074; i < 1024; ++i) { /* powers of two and their neighbours: the gaps differ on the two sides */
        double x = ldexp(1, i);
        gprojt_round_trip(x);
        gprojt_round_trip(gprojt_of_bits(gprojt_bits(x) + 1));
        if (i > -1074) gprojt_round_trip(gprojt_of_bits(gprojt_bits(x) - 1));
    }
    for (i = 1; i < 2000; ++i) gprojt_round_trip(gprojt_of_bits((uint64_t)i)); /* denormal */
}

GPROJT_TEST(read_and_write_fast_on_many) { /* without the slow comparisons: bits only */
    uint64_t state = 7;
    int i;
    char text[GPROJ_NUMBER_SIZE];
    for (i = 0; i < 300000; ++i) {
        double x = gprojt_of_bits(gprojt_random(&state)), back;
        size_t length;
        if (!isfinite(x)) continue;
        length = gproj_number_write(x, text);
        GPROJT_CHECK(gproj_number_read(text, length, &back) == length && gprojt_bits(back) == gprojt_bits(x));
    }
}

GPROJT_TEST(read_random_texts) {
    uint64_t state = 2;
    int i, k;
    char text[128];
    for (i = 0; i < 100000; ++i) {
        int digits = 1 + gprojt_below(&state, i % 3 ? 25 : 60), dot = gprojt_below(&state, digits + 1), at = 0;
        if (i & 1) text[at++] = '-';
        for (k = 0; k < digits; ++k) {
            if (k == dot) text[at++] = '.';
            text[at++] = (char)('0' + gprojt_below(&state, 10));
        }
        text[at] = 0;
        if (i & 2) snprintf(text + at, 16, "e%d", gprojt_below(&state, i & 4 ? 60 : 700) - (i & 4 ? 30 : 350));
        gprojt_same_as_strtod(text);
    }
}

GPROJT_TEST(write_digits_like_printf) {
    uint64_t state = 5;
    int i;
    char mine[GPROJ_NUMBER_SIZE], theirs[64];
    static const double ties[] = {0.5,    1.5,        2.5,    0.125, 0.375, 1e-5, 9.5, 99.5, 999.5,
                                  9999.5, 0.00099995, 5e-324, 1e300, 0,     1,    100, 1e22};
    for (i = 0; i < 60000; ++i) {
        double x = i & 1 ? gprojt_of_bits(gprojt_random(&state)) : (gprojt_uniform(&state) - 0.5) * 2000;
        int digits = 1 + gprojt_below(&state, 17);
        if (!isfinite(x)) continue;
        if (i < 17 * 17) x = ties[i / 17], digits = 1 + i % 17;
        snprintf(theirs, sizeof theirs, "%.*g", digits, x);
        GPROJT_CHECK(gproji_number_write_digits(x, digits, mine) == strlen(theirs));
        if (strcmp(mine, theirs)) {
            printf("  %%.%dg gives %s, not %s\n", digits, theirs, mine);
            gprojt_fail(__FILE__, __LINE__, "as printf");
        }
    }
}

GPROJT_TEST(comma_locale) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8",  "de_DE",       "fr_FR.UTF-8", "fr_FR.utf8",
                                        "it_IT.UTF-8", "nl_NL.UTF-8", "pl_PL.UTF-8", "German"};
    char text[GPROJ_NUMBER_SIZE];
    size_t i;
    bool comma = false;
    for (i = 0; i < sizeof names / sizeof names[0] && !comma; ++i) {
        comma = setlocale(LC_ALL, names[i]) && localeconv()->decimal_point[0] == ',';
    }
    if (!comma) {
        setlocale(LC_ALL, "C");
        GPROJT_SKIP("no locale with a decimal comma is installed");
    }
    GPROJT_CHECK(gprojt_read("1.5") == 1.5 && gprojt_read("2.5e-1") == 0.25);
    gproj_number_write(1234.5, text);
    GPROJT_CHECK(!strcmp(text, "1234.5"));
    gproji_number_write_digits(0.125, 3, text);
    GPROJT_CHECK(!strcmp(text, "0.125"));
    setlocale(LC_ALL, "C");
}

/* -- >>error -- */

GPROJT_TEST(the_first_error_stays) {
    gproj_error error, other;
    memset(&error, 0, sizeof error);
    GPROJT_CHECK(gproji_fail(&error, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, 17, "face %d", 17) == GPROJ_ERROR_INDEX);
    other = error;
    GPROJT_CHECK(gproji_fail(&error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1, "later") == GPROJ_ERROR_FILE);
    GPROJT_CHECK(error.code == GPROJ_ERROR_INDEX && error.place == GPROJ_PLACE_FACE && error.index == 17);
    GPROJT_CHECK(!strcmp(error.message, "face 17") && !memcmp(&error, &other, sizeof error));
    GPROJT_CHECK(gproji_fail(NULL, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1, "nobody") == GPROJ_ERROR_FILE);
}

/* Writes a number between +-1e200 to a state, and reads it. Returns how many bytes it has; 0 if other bits come back. */
static size_t gprojt_stored(double x) {
    uint8_t bytes[16];
    gproji_stream stream;
    double back = 0.3;
    size_t length;
    memset(&stream, 0, sizeof stream);
    gproji_pass_number(&stream, &x, -1e200, 1e200);
    length = stream.at;
    stream.mode = GPROJI_WRITE, stream.out = bytes, stream.size = length, stream.at = 0;
    gproji_pass_number(&stream, &x, -1e200, 1e200);
    stream.mode = GPROJI_READ, stream.in = bytes, stream.at = 0;
    gproji_pass_number(&stream, &back, -1e200, 1e200);
    return !stream.wrong && stream.at == length && gprojt_bits(back) == gprojt_bits(x) ? length : 0;
}

/* Eighths up to 127 have a byte in states, others nine: -0 as well, which has a sign. */
GPROJT_TEST(bytes_of_numbers) {
    static const double others[] = {-0.0, 0.0625, -0.0625, 0.1, 16, -16, 15.9375, 1.0 / 3, 1e200, -1e200, 1e-310};
    int32_t k;
    for (k = -127; k <= 127; ++k) GPROJT_CHECK(gprojt_stored(k / 8.0) == 1);
    for (k = 0; k < (int32_t)(sizeof others / sizeof others[0]); ++k) GPROJT_CHECK(gprojt_stored(others[k]) == 9);
}

int main(void) {
    GPROJT_RUN(read_hard_cases);
    GPROJT_RUN(read_ties);
    GPROJT_RUN(products_of_64_bits);
    GPROJT_RUN(read_stops_where_the_number_ends);
    GPROJT_RUN(infinity_and_nan);
    GPROJT_RUN(write_known);
    GPROJT_RUN(round_trip_random_bits);
    GPROJT_RUN(read_and_write_fast_on_many);
    GPROJT_RUN(read_random_texts);
    GPROJT_RUN(write_digits_like_printf);
    GPROJT_RUN(comma_locale);
    GPROJT_RUN(the_first_error_stays);
    GPROJT_RUN(bytes_of_numbers);
    return gprojt_report();
}
