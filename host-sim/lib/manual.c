#include "manual.h"

#include "hs/error.h"
#include "lm/version.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void print_capitals(const char *word)
{
    for (; *word; word++) {
        putchar(toupper((unsigned char)*word));
    }
}

void manual_begin(const char *command, const char *summary)
{
    const char *joint = *command ? "-" : "";
    printf(".TH ");
    print_capitals(hs_program());
    printf("%s", joint);
    print_capitals(command);
    printf(" 1 \"\" \"landmass %s\" \"landmass tools\"\n.ad l\n.SH NAME\n", LM_VERSION);
    manual_text(hs_program());
    manual_text(joint);
    manual_text(command);
    printf(" \\- ");
    manual_text(summary);
    printf("\n");
}

static void print_escaped(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\\') {
            printf("\\e");
        } else if (text[i] == '-') {
            printf("\\-");
        } else if (text[i] == ',' && i + 1 < length && text[i + 1] != ' ') {
            printf(",\\:"); /* a list without blanks may be broken here */
        } else {
            printf("%s%c", i == 0 && (text[i] == '.' || text[i] == '\'') ? "\\&" : "", text[i]);
        }
    }
}

void manual_text(const char *text)
{
    print_escaped(text, strlen(text));
}

void manual_paragraphs(const char *text)
{
    bool is_kept = false;
    while (*text) {
        const size_t length = strcspn(text, "\n");
        const bool keeps = *text == ' ';
        if (keeps != is_kept) {
            printf("%s\n", keeps ? ".PP\n.nf" : ".fi\n.PP");
            is_kept = keeps;
        }
        if (length == 0) {
            printf("%s", is_kept ? "" : ".PP");
        }
        print_escaped(text, length);
        printf("\n");
        text += length + (text[length] == '\n');
    }
    printf("%s", is_kept ? ".fi\n" : "");
}

void manual_filled(const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        printf("%s", *text == ' ' ? ".br\n" : "");
        print_escaped(text, length);
        printf("\n");
        text += length + (text[length] == '\n');
    }
}

void manual_exit_status(void)
{
    printf(".SH EXIT STATUS\n");
    static const char *const meanings[] = {"The work is done.",
                                           "The work could not be done; standard error says why.",
                                           "The command line makes no sense."};
    for (int code = HS_EXIT_OK; code <= HS_EXIT_USAGE; code++) {
        printf(".TP\n.B %d\n%s\n", code, meanings[code]);
    }
}
