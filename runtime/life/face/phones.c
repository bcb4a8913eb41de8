/* phones.c: the mouth shape of each phone.
 *
 * ARPABET is recognised by its capitals; stress digits are skipped. In the International Phonetic Alphabet a phone has
 * one or several characters: stress, length and other marks are skipped, an affricate is one shape, and a diphthong has
 * the shapes of its first and last vowel. */
#include "core/base/assert_internal.h"
#include "noh/face.h"

typedef struct entry {
    const char *phone;
    uint8_t first, second;
} entry;

#define SIL NOH_VISEME_SIL
#define PP NOH_VISEME_PP
#define FF NOH_VISEME_FF
#define TH NOH_VISEME_TH
#define DD NOH_VISEME_DD
#define KK NOH_VISEME_KK
#define CH NOH_VISEME_CH
#define SS NOH_VISEME_SS
#define NN NOH_VISEME_NN
#define RR NOH_VISEME_RR
#define AA NOH_VISEME_AA
#define EE NOH_VISEME_E
#define IH NOH_VISEME_IH
#define OH NOH_VISEME_OH
#define OU NOH_VISEME_OU
#define NONE NOH_VISEME_COUNT

/* clang-format off */
static const entry arpabet[] = {
    {"P", PP, NONE}, {"B", PP, NONE}, {"M", PP, NONE}, {"EM", PP, NONE}, {"PT", PP, NONE}, {"BT", PP, NONE}, {"F", FF, NONE}, {"V", FF, NONE},
    {"TH", TH, NONE}, {"DH", TH, NONE}, {"T", DD, NONE}, {"D", DD, NONE}, {"DX", DD, NONE},
    {"K", KK, NONE}, {"G", KK, NONE}, {"NG", KK, NONE}, {"HH", KK, NONE}, {"HV", KK, NONE},
    {"CH", CH, NONE}, {"JH", CH, NONE}, {"SH", CH, NONE}, {"ZH", CH, NONE}, {"S", SS, NONE}, {"Z", SS, NONE},
    {"N", NN, NONE}, {"EN", NN, NONE}, {"NX", NN, NONE}, {"L", NN, NONE}, {"EL", NN, NONE},
    {"R", RR, NONE}, {"ER", RR, NONE}, {"AXR", RR, NONE},
    {"AA", AA, NONE}, {"AE", AA, NONE}, {"AH", AA, NONE}, {"AX", AA, NONE}, {"AY", AA, IH}, {"AW", AA, OU},
    {"EH", EE, NONE}, {"EY", EE, IH}, {"IH", IH, NONE}, {"IX", IH, NONE}, {"IY", IH, NONE}, {"Y", IH, NONE},
    {"AO", OH, NONE}, {"OW", OH, OU}, {"OY", OH, IH}, {"UH", OU, NONE}, {"UW", OU, NONE}, {"UX", OU, NONE},
    {"W", OU, NONE}, {"WH", OU, NONE}, {"SIL", SIL, NONE}, {"PAU", SIL, NONE}, {"SP", SIL, NONE}, {"Q", SIL, NONE},
};
static const entry ipa[] = {
    {"t\xca\x83", CH, NONE}, {"d\xca\x92", CH, NONE}, /* tesh, dezh: before their first characters */
    {"p", PP, NONE}, {"b", PP, NONE}, {"m", PP, NONE}, {"f", FF, NONE}, {"v", FF, NONE},
    {"\xce\xb8", TH, NONE}, {"\xc3\xb0", TH, NONE},                          /* theta, eth */
    {"t", DD, NONE}, {"d", DD, NONE}, {"\xc9\xbe", DD, NONE},                /* flap */
    {"k", KK, NONE}, {"g", KK, NONE}, {"\xc9\xa1", KK, NONE}, {"\xc5\x8b", KK, NONE}, {"h", KK, NONE}, {"x", KK, NONE},
    {"\xc3\xa7", KK, NONE},                                                  /* ich */
    {"\xca\x83", CH, NONE}, {"\xca\x92", CH, NONE}, {"s", SS, NONE}, {"z", SS, NONE},
    {"n", NN, NONE}, {"l", NN, NONE}, {"\xc9\xab", NN, NONE}, {"\xc9\xb2", NN, NONE},
    {"\xc9\xb9", RR, NONE}, {"r", RR, NONE}, {"\xca\x81", KK, NONE}, {"\xc9\x9a", RR, NONE}, {"\xc9\x9c", RR, NONE},
    {"\xc9\x9d", RR, NONE},
    {"a", AA, NONE}, {"\xc9\x91", AA, NONE}, {"\xc9\x90", AA, NONE}, {"\xc3\xa6", AA, NONE}, {"\xca\x8c", AA, NONE},
    {"\xc9\x99", AA, NONE},                                                  /* schwa */
    {"\xc9\x9b", EE, NONE}, {"e", EE, NONE}, {"\xc5\x93", EE, NONE}, {"\xc3\xb8", EE, NONE},
    {"i", IH, NONE}, {"\xc9\xaa", IH, NONE}, {"\xe1\xb5\xbb", IH, NONE}, {"j", IH, NONE},
    {"\xc9\x92", OH, NONE}, {"\xc9\x94", OH, NONE}, {"o", OH, NONE},
    {"u", OU, NONE}, {"\xca\x8a", OU, NONE}, {"\xca\x89", OU, NONE}, {"w", OU, NONE}, {"\xca\x8d", OU, NONE},
    {"y", OU, NONE}, {"\xca\x8f", OU, NONE}, {"_", SIL, NONE}, {"\xca\x94", SIL, NONE},
};
/* clang-format on */

/* The number of characters of `text` that match `start`, if it begins with it; else 0. */
static uint32_t begins_with(const char *text, const char *start)
{
    uint32_t length = 0;
    while (start[length] && text[length] == start[length]) length++;
    return start[length] ? 0u : length;
}

static int is_stress(const char *text)
{
    while (*text >= '0' && *text <= '9') text++;
    return *text == 0;
}

static noh_viseme of_arpabet(const char *phone, noh_viseme *second)
{
    for (uint32_t i = 0; i < sizeof arpabet / sizeof arpabet[0]; i++) {
        const uint32_t length = begins_with(phone, arpabet[i].phone);
        if (length && is_stress(phone + length)) {
            *second = (noh_viseme)arpabet[i].second;
            return (noh_viseme)arpabet[i].first;
        }
    }
    return NOH_VISEME_COUNT;
}

/* The entry that `text` begins with, and its length; NULL and 1 for a mark or an unknown character. */
static const entry *ipa_at(const char *text, uint32_t *length)
{
    for (uint32_t i = 0; i < sizeof ipa / sizeof ipa[0]; i++) {
        *length = begins_with(text, ipa[i].phone);
        if (*length) return &ipa[i];
    }
    *length = 1;
    return NULL;
}

static noh_viseme of_ipa(const char *phone, noh_viseme *second)
{
    noh_viseme first = NOH_VISEME_COUNT, last = NOH_VISEME_COUNT;
    uint32_t length;
    for (; *phone; phone += length) {
        const entry *e = ipa_at(phone, &length);
        if (e) {
            last = (noh_viseme)e->first;
            first = first == NOH_VISEME_COUNT ? last : first;
        }
    }
    *second = last == first ? NOH_VISEME_COUNT : last;
    return first;
}

noh_viseme noh_viseme_of_phone(const char *phone, noh_viseme *second)
{
    noh_viseme moved = NOH_VISEME_COUNT, found;
    NOH_ASSERT(phone);
    if (phone[0] == 0) {
        found = NOH_VISEME_SIL;
    } else if (phone[0] >= 'A' && phone[0] <= 'Z') {
        found = of_arpabet(phone, &moved);
    } else {
        found = of_ipa(phone, &moved);
    }
    if (second) *second = moved;
    return found;
}
