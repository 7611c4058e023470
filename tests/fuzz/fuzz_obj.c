/* The look at an OBJ file before Assimp reads it: each line of what is accepted is read once more,
 * with the C library, by the rules of obj_check.h. */
#include <ctype.h>
#include <strings.h>

#include "fuzz.h"
#include "obj_check.h"

const uint32_t fuzz_mutations = 4000;

static void check_vertex(char **rest)
{
    int numbers = 0;
    for (char *word; (word = strtok_r(NULL, " \t\r", rest)) != NULL; numbers++) {
        FUZZ_ASSERT(isdigit((unsigned char)*word) || strchr("+-", *word) ||
                    strncasecmp(word, "nan", 3) == 0 || strncasecmp(word, "inf", 3) == 0);
    }
    FUZZ_ASSERT(numbers == 3 || numbers == 4 || numbers == 6);
}

static void check_line(char *line)
{
    char *rest = NULL;
    const char before = *line;
    line[strcspn(line, "#")] = '\0';
    const char *first = strtok_r(line, " \t\r", &rest);
    if (!first) {
        return;
    }
    if (strcmp(first, "v") == 0) {
        check_vertex(&rest);
    }
    if (strcmp(first, "v") == 0 || strcmp(first, "f") == 0 || strcmp(first, "usemtl") == 0) {
        FUZZ_ASSERT(!strchr(" \t\r", before));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    if (memchr(data, 0, size)) {
        return 0; /* the C library would end the line there */
    }
    fuzz_file_open(&file, data, size);
    if (obj_check(file.path, "input") == 0) {
        char *text = malloc(size + 1), *rest = text;
        FUZZ_ASSERT(text);
        memcpy(text, data, size);
        text[size] = '\0';
        for (char *line; (line = strsep(&rest, "\n")) != NULL;) {
            check_line(line);
        }
        free(text);
    }
    fuzz_file_close(&file);
    return 0;
}
