#include "events_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void store(uint64_t bits, uint8_t out[8])
{
    for (int i = 0; i < 8; ++i) out[i] = (uint8_t)(bits >> (8 * i));
}

static int digit_of(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : 99;
}

static int parse_whole(const char *text, size_t size, uint64_t base, uint64_t *out)
{
    *out = 0;
    for (size_t i = 0; i < size; ++i) {
        const uint64_t digit = (uint64_t)digit_of(text[i]);
        if (digit >= base || *out > (UINT64_MAX - digit) / base) return 0;
        *out = *out * base + digit;
    }
    return size > 0;
}

static int parse_real(const char *text, size_t size, uint64_t *bits)
{
    char digits[64], *end = digits;
    if (size == 0 || size >= sizeof digits) return 0;
    memcpy(digits, text, size);
    digits[size] = '\0';
    /* a whole number too large for an integer is not read as a float */
    if (strspn(digits, "+-.0123456789eE") != size || !strpbrk(digits, ".eE")) return 0;
    double value = strtod(digits, &end);
    memcpy(bits, &value, sizeof *bits);
    return end == digits + size && isfinite(value);
}

int event_payload(const char *text, size_t size, uint8_t out[8])
{
    uint64_t bits = 0;
    int negative = size > 0 && text[0] == '-';
    size_t sign = size > 0 && (negative || text[0] == '+');
    if (size > 2 && text[0] == '0' && (text[1] | 0x20) == 'x') {
        if (!parse_whole(text + 2, size - 2, 16, &bits)) return 0;
    } else if (parse_whole(text + sign, size - sign, 10, &bits)) {
        if (negative && bits > (UINT64_C(1) << 63)) return 0;
        bits = negative ? 0 - bits : bits;
    } else if (!parse_real(text, size, &bits)) {
        return 0;
    }
    store(bits, out);
    return 1;
}
