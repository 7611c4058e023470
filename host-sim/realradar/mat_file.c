#include "mat_file.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Types of data elements and classes of arrays: MAT-File Format, tables 1-1 and 1-3. */
enum { INT8 = 1, UINT8, INT16, UINT16, INT32, UINT32, SINGLE, DOUBLE = 9, MATRIX = 14, COMPRESSED };
enum { CLASS_STRUCT = 2, CLASS_DOUBLE = 6, CLASS_SINGLE = 7, FLAG_COMPLEX = 0x08 };

enum { HEADER_SIZE = 128, TAG_SIZE = 8, SMALL_MOST = 4, BYTES_MOST = 256 << 20 };

static const char remedy[] = "give a whole phase history file of the Gotcha data set";

struct element {
    uint32_t type;
    struct rr_mat_slice data;
};

struct matrix {
    uint32_t class_number, flags;
    size_t rows, columns;
    struct rr_mat_slice name, content;
};

static void advance(struct rr_mat_slice *s, size_t size)
{
    const size_t step = size < s->size ? size : s->size;
    s->at += step;
    s->size -= step;
}

/* Take the next element off `rest`. Small ones keep type, size and data in one tag; others begin on
 * multiples of 8 bytes, except after compressed ones. False at the end, or when the element is
 * torn. */
static bool take(struct rr_mat_slice *rest, struct element *e)
{
    uint32_t tag[2];
    if (rest->size < TAG_SIZE) {
        return false;
    }
    memcpy(tag, rest->at, sizeof tag);
    if (tag[0] >> 16) {
        *e = (struct element){tag[0] & 0xffffu, {rest->at + 4, tag[0] >> 16}};
        advance(rest, TAG_SIZE);
        return e->data.size <= SMALL_MOST;
    }
    advance(rest, TAG_SIZE);
    *e = (struct element){tag[0], {rest->at, tag[1]}};
    const bool is_whole = e->data.size <= rest->size;
    advance(rest, e->type == COMPRESSED ? e->data.size : (e->data.size + 7) / 8 * 8);
    return is_whole;
}

static bool open_matrix(struct matrix *m, struct rr_mat_slice data)
{
    struct element flags, size, name;
    int32_t dimension[2];
    if (!take(&data, &flags) || !take(&data, &size) || !take(&data, &name) ||
        flags.type != UINT32 || flags.data.size != 8 || size.type != INT32 ||
        size.data.size != sizeof dimension || name.type != INT8) {
        return false;
    }
    memcpy(dimension, size.data.at, sizeof dimension);
    m->class_number = flags.data.at[0];
    m->flags = flags.data.at[1];
    m->name = name.data;
    m->content = data;
    if (dimension[0] < 1 || dimension[1] < 1) {
        return false;
    }
    m->rows = (size_t)dimension[0];
    m->columns = (size_t)dimension[1];
    return true;
}

static bool is_called(struct rr_mat_slice name, const char *wanted)
{
    return name.size == strlen(wanted) && memcmp(name.at, wanted, name.size) == 0;
}

/* Inflate a compressed element, doubling the room until it fits. NULL when it is torn or too large.
 */
static uint8_t *inflate_element(struct rr_mat_slice packed, size_t *size)
{
    for (size_t room = 4 * packed.size + 64; room <= BYTES_MOST; room *= 2) {
        uint8_t *bytes = malloc(room);
        uLongf used = room;
        const int result = bytes ? uncompress(bytes, &used, packed.at, packed.size) : Z_MEM_ERROR;
        if (result == Z_OK) {
            *size = used;
            return bytes;
        }
        free(bytes);
        if (result != Z_BUF_ERROR) {
            break;
        }
    }
    return NULL;
}

/* The struct's three parts: the size of a name, the names, the fields. */
static bool open_struct(struct rr_mat_file *file, struct rr_mat_slice data, const char *variable)
{
    struct matrix m;
    struct element name_size, names;
    int32_t size;
    if (!open_matrix(&m, data) || m.class_number != CLASS_STRUCT || m.rows != 1 || m.columns != 1 ||
        !is_called(m.name, variable) || !take(&m.content, &name_size) ||
        !take(&m.content, &names) || name_size.type != INT32 ||
        name_size.data.size != sizeof size || names.type != INT8) {
        return false;
    }
    memcpy(&size, name_size.data.at, sizeof size);
    file->name_size = size > 0 ? (size_t)size : 0;
    file->names = names.data;
    file->fields = m.content;
    return size > 0;
}

static bool find_struct(struct rr_mat_file *file, struct rr_mat_slice rest, const char *variable)
{
    struct element e;
    while (take(&rest, &e)) {
        if (e.type == MATRIX && open_struct(file, e.data, variable)) {
            return true;
        }
        size_t size = 0;
        uint8_t *bytes = e.type == COMPRESSED ? inflate_element(e.data, &size) : NULL;
        struct rr_mat_slice inflated = {bytes, size};
        struct element inner;
        if (bytes && take(&inflated, &inner) && inner.type == MATRIX &&
            open_struct(file, inner.data, variable)) {
            file->inflated = bytes;
            return true;
        }
        free(bytes);
    }
    return false;
}

/* The whole file, or NULL, reported. */
static uint8_t *load(const char *path, size_t *size)
{
    FILE *stream = hs_input_open(path, "rb");
    uint8_t *bytes = NULL;
    if (!stream) {
        hs_error(path, remedy, "cannot be opened: %s", strerror(errno));
        return NULL;
    }
    const long end = fseek(stream, 0, SEEK_END) == 0 ? ftell(stream) : -1;
    if (end < HEADER_SIZE || end > BYTES_MOST || fseek(stream, 0, SEEK_SET) != 0) {
        hs_error(path, remedy, "is not a MATLAB file of level 5");
    } else {
        *size = (size_t)end;
        bytes = malloc(*size);
        if (!bytes || fread(bytes, 1, *size, stream) != *size) {
            hs_error(path, NULL, "cannot be read: %s", strerror(errno));
            free(bytes);
            bytes = NULL;
        }
    }
    fclose(stream);
    return bytes;
}

int rr_mat_open(struct rr_mat_file *file, const char *path, const char *variable)
{
    /* Version and byte order end the header; read the wrong way round they are something else. */
    static const uint16_t version = 0x0100, order = 0x4d49;
    size_t size = 0;
    *file = (struct rr_mat_file){.path = path, .bytes = load(path, &size)};
    if (!file->bytes) {
        return -1;
    }
    const uint8_t *bytes = file->bytes;
    if (memcmp(bytes + HEADER_SIZE - 4, &version, 2) != 0 ||
        memcmp(bytes + HEADER_SIZE - 2, &order, 2) != 0) {
        rr_mat_close(file);
        return hs_error(path, remedy, "is not a MATLAB file of level 5");
    }
    if (!find_struct(file, (struct rr_mat_slice){bytes + HEADER_SIZE, size - HEADER_SIZE},
                     variable)) {
        rr_mat_close(file);
        return hs_error(path, remedy, "has no whole struct called %s", variable);
    }
    return 0;
}

static size_t value_size(uint32_t type)
{
    static const uint8_t sizes[] = {
        [INT8] = 1,  [UINT8] = 1,  [INT16] = 2,  [UINT16] = 2,
        [INT32] = 4, [UINT32] = 4, [SINGLE] = 4, [DOUBLE] = 8,
    };
    return type < sizeof sizes ? sizes[type] : 0;
}

static bool take_numbers(struct rr_mat_slice *rest, size_t count, struct rr_mat_numbers *numbers)
{
    struct element e;
    if (!take(rest, &e)) {
        return false;
    }
    *numbers = (struct rr_mat_numbers){e.type, e.data};
    const size_t size = value_size(e.type);
    return size > 0 && e.data.size / size == count && e.data.size % size == 0;
}

static bool open_array(struct rr_mat_array *array, struct rr_mat_slice data)
{
    struct matrix m;
    if (!open_matrix(&m, data) ||
        (m.class_number != CLASS_SINGLE && m.class_number != CLASS_DOUBLE)) {
        return false;
    }
    /* Both sizes are below 2^31, so their product fits. */
    const size_t count = m.rows * m.columns;
    *array = (struct rr_mat_array){
        .rows = m.rows, .columns = m.columns, .is_complex = m.flags & FLAG_COMPLEX};
    return take_numbers(&m.content, count, &array->real) &&
           (!array->is_complex || take_numbers(&m.content, count, &array->imaginary));
}

int rr_mat_field(const struct rr_mat_file *file, const char *name, struct rr_mat_array *array)
{
    struct rr_mat_slice fields = file->fields, names = file->names;
    struct element e;
    for (; names.size >= file->name_size && take(&fields, &e); advance(&names, file->name_size)) {
        const struct rr_mat_slice own = {names.at,
                                         strnlen((const char *)names.at, file->name_size)};
        if (is_called(own, name) && e.type == MATRIX && open_array(array, e.data)) {
            return 0;
        }
    }
    return hs_error(file->path, remedy, "data.%s is missing, torn or no array of numbers", name);
}

static double number(const struct rr_mat_numbers *numbers, size_t i)
{
    const uint8_t *at = numbers->bytes.at + i * value_size(numbers->type);
    union {
        int8_t i8;
        uint8_t u8;
        int16_t i16;
        uint16_t u16;
        int32_t i32;
        uint32_t u32;
        float f32;
        double f64;
    } value = {.f64 = 0};
    memcpy(&value, at, value_size(numbers->type));
    switch (numbers->type) {
    case INT8:
        return value.i8;
    case UINT8:
        return value.u8;
    case INT16:
        return value.i16;
    case UINT16:
        return value.u16;
    case INT32:
        return value.i32;
    case UINT32:
        return value.u32;
    case SINGLE:
        return (double)value.f32;
    default:
        return value.f64;
    }
}

double rr_mat_real(const struct rr_mat_array *array, size_t i)
{
    return number(&array->real, i);
}

double rr_mat_imaginary(const struct rr_mat_array *array, size_t i)
{
    return array->is_complex ? number(&array->imaginary, i) : 0;
}

void rr_mat_close(struct rr_mat_file *file)
{
    free(file->bytes);
    free(file->inflated);
    file->bytes = file->inflated = NULL;
}
