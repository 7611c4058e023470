/* A fuzz target as a plain test: the committed inputs as they are, then mutations of them from a
 * fixed seed. The sanitizers judge. Usage: test_fuzz_NAME [CORPUS-FOLDER [MUTATIONS]] */
#include "fuzz.h"
#include "hs/rng.h"

#include <dirent.h>
#include <sanitizer/asan_interface.h>
#include <sys/stat.h>

enum { INPUT_MAX = 1 << 16, SEEDS_MAX = 64 };

struct input {
    size_t size;
    uint8_t bytes[INPUT_MAX];
};

/* What is being tried, for whoever has to find out why the program died. */
static struct input now;
static const char *name;

static void keep_input(void)
{
    char path[256];
    const char *build = getenv("BUILD");
    snprintf(path, sizeof path, "%s/tmp", build ? build : "/tmp");
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/tmp/crash-%s", build ? build : "/tmp", name);
    FILE *file = fopen(path, "wb");
    if (file) {
        fwrite(now.bytes, 1, now.size, file);
        fclose(file);
        fprintf(stderr, "# the input is kept in %s\n", path);
    }
}

/* A promise that does not hold (FUZZ_ASSERT) ends like a finding of the sanitizer: with the input
 * kept. */
const char *__asan_default_options(void)
{
    return "handle_abort=1";
}

static void run(void)
{
    /* A block of its own for each input, so that reading past its end is seen. */
    uint8_t *exact = malloc(now.size ? now.size : 1);
    FUZZ_ASSERT(exact);
    memcpy(exact, now.bytes, now.size);
    LLVMFuzzerTestOneInput(exact, now.size);
    free(exact);
}

static int by_name(const void *a, const void *b)
{
    const struct input *const *p = a, *const *q = b;
    const size_t n = (*p)->size < (*q)->size ? (*p)->size : (*q)->size;
    const int order = memcmp((*p)->bytes, (*q)->bytes, n);
    return order ? order : ((*p)->size > (*q)->size) - ((*p)->size < (*q)->size);
}

/* Read the corpus in an order that does not depend on the file system. */
static size_t read_corpus(const char *folder, struct input *seeds[SEEDS_MAX])
{
    size_t count = 0;
    DIR *dir = opendir(folder);
    for (struct dirent *e; dir && (e = readdir(dir)) != NULL && count < SEEDS_MAX;) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        FILE *file = e->d_name[0] == '.' ? NULL : fopen(path, "rb");
        if (file) {
            struct input *seed = calloc(1, sizeof *seed);
            FUZZ_ASSERT(seed);
            seed->size = fread(seed->bytes, 1, INPUT_MAX, file);
            fclose(file);
            seeds[count++] = seed;
        }
    }
    if (dir) {
        closedir(dir);
    }
    qsort(seeds, count, sizeof *seeds, by_name);
    return count;
}

static void insert(const uint8_t *from, size_t length, size_t at)
{
    length = length < INPUT_MAX - now.size ? length : INPUT_MAX - now.size;
    uint8_t copy[256];
    length = length < sizeof copy ? length : sizeof copy;
    memcpy(copy, from, length);
    memmove(now.bytes + at + length, now.bytes + at, now.size - at);
    memcpy(now.bytes + at, copy, length);
    now.size += length;
}

static void erase(size_t at, size_t length)
{
    length = length < now.size - at ? length : now.size - at;
    memmove(now.bytes + at, now.bytes + at + length, now.size - at - length);
    now.size -= length;
}

/* Numbers at which things break, in binary and in text. */
static void overwrite_number(struct hs_rng *rng, size_t at)
{
    static const uint32_t numbers[] = {0,          1,          0x7F,       0x80,       0xFF,
                                       0x7FFF,     0x8000,     0xFFFF,     0x10000,    0x7FFFFFFF,
                                       0x80000000, 0xFFFFFFFF, 0xFFFFFFFE, 0x40000000, 0xC0000000};
    const uint32_t value = numbers[hs_rng_below(rng, sizeof numbers / sizeof *numbers)];
    const size_t width = (size_t)1 << hs_rng_below(rng, 3);
    if (now.size - at >= width) {
        memcpy(now.bytes + at, &value, width);
    }
}

static void insert_word(struct hs_rng *rng, size_t at)
{
    static const char *const words[] = {
        "-",   "nan",          "1e308", "-1e-308", "99999999999999999999",
        "inf", "\n",           "\r\n",  ",",       "#",
        " ",   "\t",           "\"",    "<",       "0x1p1023",
        "",    "\xEF\xBB\xBF", "[",     "]",       "="};
    const char *word = words[hs_rng_below(rng, sizeof words / sizeof *words)];
    insert((const uint8_t *)word, strlen(word), at);
}

static void mutate(struct hs_rng *rng, const struct input *other)
{
    const size_t at = now.size ? hs_rng_below(rng, (uint32_t)now.size) : 0;
    const uint8_t byte = (uint8_t)hs_rng_u64(rng);
    switch (hs_rng_below(rng, 8)) {
    case 0:
        now.bytes[at] ^= (uint8_t)(1u << (byte & 7));
        break;
    case 1:
        now.bytes[at] = byte;
        break;
    case 2:
        overwrite_number(rng, at);
        break;
    case 3:
        insert_word(rng, at);
        break;
    case 4:
        erase(at, 1u + (byte >> (byte & 7)));
        break;
    case 5:
        insert(&byte, 1, at);
        break;
    case 6:
        insert(now.bytes + at, byte < now.size - at ? byte : now.size - at, at);
        break;
    default:
        if (other->size) {
            const size_t from = hs_rng_below(rng, (uint32_t)other->size);
            insert(other->bytes + from, byte < other->size - from ? byte : other->size - from, at);
        }
    }
}

int main(int argc, char **argv)
{
    static const char prefix[] = "test_fuzz_";
    struct input *seeds[SEEDS_MAX];
    char folder[512];
    struct hs_rng rng;
    const char *program = strrchr(argv[0], '/') ? strrchr(argv[0], '/') + 1 : argv[0];
    name = strncmp(program, prefix, sizeof prefix - 1) == 0 ? program + sizeof prefix - 1 : program;
    snprintf(folder, sizeof folder, "tests/fuzz/corpus/%s", name);
    const size_t count = read_corpus(argc > 1 ? argv[1] : folder, seeds);
    const uint32_t mutations = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : fuzz_mutations;
    if (count == 0) {
        printf("1..1\nnot ok 1 - there are inputs in %s\n", folder);
        return 1;
    }
    __sanitizer_set_death_callback(keep_input);
    printf("1..2\n");
    for (size_t i = 0; i < count; i++) {
        now = *seeds[i];
        run();
    }
    printf("ok 1 - the %zu inputs of %s are taken without a fault\n", count, folder);
    fflush(stdout);
    hs_rng_seed(&rng, 1);
    for (uint32_t i = 0; i < mutations; i++) {
        now = *seeds[hs_rng_below(&rng, (uint32_t)count)];
        for (uint32_t n = 1 + hs_rng_below(&rng, 8); n > 0; n--) {
            mutate(&rng, seeds[hs_rng_below(&rng, (uint32_t)count)]);
        }
        run();
    }
    printf("ok 2 - so are %u mutations of them\n", mutations);
    for (size_t i = 0; i < count; i++) {
        free(seeds[i]);
    }
    return 0;
}
