#include "bus/print.h"

#include "bus/control_rows.h"
#include "bus/words.h"
#include "drv/can_socket.h"
#include "hs/report.h"
#include "lm/bus_filters.h"
#include "lm/canas.h"
#include "lm/canas_control.h"
#include "lm/canas_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct lm_bus_scale *unit_of(const struct lm_bus_row *row)
{
    return lm_bus_scale_of((enum lm_bus_field)row->field);
}

/* Counts of the row's field in one unit of the bus. */
static double counts_per_unit(const struct lm_bus_row *row)
{
    return ldexp(unit_of(row)->multiplier, unit_of(row)->frac_bits) / unit_of(row)->divisor;
}

/* What a packed row makes of an integer or float of the frame: value = number * scale + offset, in
 * the field's unit of the bus. Of the scale the shortest number that gives the row's multiplier. */
static double scale_of(const struct lm_bus_row *row)
{
    const struct lm_bus_packing *p = &row->packing;
    const int places = (p->type == LM_BUS_FLOAT ? p->frac_bits : 0) - p->shift;
    const double one = counts_per_unit(row);
    double scale = ldexp(p->multiplier, places) / one;
    for (int digits = 1; digits <= 12; digits++) {
        char text[32];
        snprintf(text, sizeof text, "%.*g", digits, scale);
        if (lround(ldexp(strtod(text, NULL) * one, -places)) == p->multiplier) {
            return strtod(text, NULL);
        }
    }
    return scale;
}

static double offset_of(const struct lm_bus_row *row)
{
    const double offset =
        (ldexp((double)row->packing.bias, -row->packing.shift) - 0.5) / counts_per_unit(row);
    return fabs(offset) > 1e-9 ? offset : 0;
}

/* ---- filters ---- */

void bus_print_filters(FILE *out, const struct lm_bus_profile *profile)
{
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    const uint32_t count = lm_bus_filters(profile, filters);
    hs_report_put("filters", count);
    for (uint32_t i = 0; i < count; i++) {
        const struct can_filter kernels = drv_can_socket_filter(&filters[i]);
        fprintf(out, filters[i].is_extended ? "%08X:%08X\n" : "%03X:%08X\n", filters[i].id,
                kernels.can_mask);
    }
}

/* ---- Markdown ---- */

static void print_types(FILE *out, const struct lm_bus_row *row)
{
    const char *comma = "";
    for (int type = 0; type < LM_CANAS_TYPES; type++) {
        if (row->types >> type & 1) {
            fprintf(out, "%s%s", comma, lm_canas_types[type].name);
            comma = ", ";
        }
    }
}

static const char *packed_type_name(const struct lm_bus_packing *p)
{
    static const char *const names[] = {"unsigned", "signed", "float"};
    return names[p->type];
}

static void print_place(FILE *out, const struct lm_bus_row *row)
{
    const struct lm_bus_packing *p = &row->packing;
    fprintf(out, "%s %u+%u %s, x %.12g", p->is_little_endian ? "little" : "big", p->bits.first,
            p->bits.count, packed_type_name(p), scale_of(row));
    if (offset_of(row) != 0) {
        fprintf(out, " %+.8g", offset_of(row));
    }
    if (p->is_fast) {
        fprintf(out, ", fast packet");
    }
    if (p->match.count != 0) {
        fprintf(out, ", when %u+%u = %u", p->match.first, p->match.count, p->match_value);
    }
}

void bus_print_table(FILE *out, const struct lm_bus_profile *profile)
{
    const bool is_packed = profile->framing == LM_BUS_PACKED;
    fprintf(out,
            "| id | hex | item | field | %s | unit | range | kept as | period ms | stale | dead | "
            "priority |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
            is_packed ? "bits" : "types");
    for (int i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        fprintf(out, is_packed ? "| %u | %08X | %s | %s | " : "| %u | %03X | %s | %s | ", row->id,
                row->id, row->name, lm_bus_fields[row->field].name);
        if (is_packed) {
            print_place(out, row);
        } else {
            print_types(out, row);
        }
        fprintf(out, " | %s | %d..%d | %s | %g | %u | %u | %u |\n", unit_of(row)->bus_unit,
                row->low, row->high, unit_of(row)->kept_as, row->period_us / 1000.0, row->stale_ms,
                row->dead_ms, row->priority);
    }
}

void bus_print_fields(FILE *out)
{
    hs_report_array("fields");
    for (int i = 0; i < LM_BUS_FIELDS; i++) {
        const char *unit = lm_bus_scale_of((enum lm_bus_field)i)->bus_unit;
        fprintf(out, "%-18s %s\n", lm_bus_fields[i].name, unit);
        hs_report_object(NULL);
        hs_report_put("name", lm_bus_fields[i].name);
        hs_report_put("unit", unit);
        hs_report_close();
    }
    hs_report_close();
}

void bus_print_reports(FILE *out)
{
    fprintf(out,
            "| id | hex | item | type | unit or bytes | counts in a unit | period ms |\n"
            "|---|---|---|---|---|---|---|\n");
    hs_report_put("reports", LM_REPORT_ITEMS);
    for (int i = 0; i < LM_REPORT_ITEMS; i++) {
        const struct lm_report_row *row = &lm_report_rows[i];
        fprintf(out, "| %u | %03X | %s | %s | %s | %d | %u |\n", row->id, row->id, row->name,
                lm_canas_types[row->type].name, row->unit, row->per_unit,
                lm_report_period_us[row->set] / 1000);
    }
}

void bus_print_controls(FILE *out)
{
    fprintf(out,
            "| id | hex | item | type | unit or bytes | counts in a unit |\n"
            "|---|---|---|---|---|---|\n");
    hs_report_put("controls", LM_CONTROL_ITEMS + 1);
    for (int i = 0; i <= LM_CONTROL_ITEMS; i++) {
        const struct lm_report_row row = i < LM_CONTROL_ITEMS ? bus_control_row(i) : bus_swap_row();
        fprintf(out, "| %u | %03X | %s | %s | %s | %d |\n", row.id, row.id, row.name,
                lm_canas_types[row.type].name, row.unit, row.per_unit);
    }
}

/* ---- .dbc ---- */

enum { DBC_NAME_BYTES = 32 }; /* what other tools allow, and a NUL less */

/* A name of letters, digits and underscores, made unlike others by its row where it was cut. */
static void print_name(FILE *out, const char *text, int row)
{
    char name[DBC_NAME_BYTES];
    size_t length = 0;
    for (; *text != '\0' && length < sizeof name - 5; text++) {
        const char c = *text;
        const bool is_word =
            (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        if (is_word) {
            name[length++] = c;
        } else if (length > 0 && name[length - 1] != '_') {
            name[length++] = '_';
        }
    }
    length -= length > 0 && name[length - 1] == '_';
    name[length] = '\0';
    const bool begins_well = length > 0 && (name[0] < '0' || name[0] > '9');
    if (*text != '\0' || !begins_well) {
        fprintf(out, "%s%s_%d", begins_well ? "" : "item", name, row);
    } else {
        fprintf(out, "%s", name);
    }
}

/* The number of a run's first bit as .dbc has it: bit 7 of byte 0 is 7, and a big-endian signal is
 * named by its highest bit. */
static unsigned dbc_start(struct lm_bus_bits bits, bool is_little_endian)
{
    return is_little_endian ? bits.first : bits.first / 8 * 8u + 7 - bits.first % 8;
}

struct signal {
    const char *name, *multiplex; /* "m2 ", "M ", or "" */
    unsigned byte, bytes;
    bool is_signed;
    double scale;
    int low, high;
    const char *unit;
};

/* Big-endian, as CANaerospace has it. */
static void print_signal(FILE *out, const struct signal *s)
{
    fprintf(out, " SG_ %s %s: %u|%u@0%c (%.10g,0) [%d|%d] \"%s\" Vector__XXX\n", s->name,
            s->multiplex, s->byte * 8 + 7, s->bytes * 8, s->is_signed ? '-' : '+', s->scale, s->low,
            s->high, s->unit);
}

static void print_header_signals(FILE *out, bool is_multiplexed)
{
    static const struct signal header[] = {
        {"node", "", 0, 1, false, 1, 0, 255, ""},
        {"data_type", "", 1, 1, false, 1, 0, 255, ""},
        {"service_code", "", 2, 1, false, 1, 0, 255, ""},
        {"message_code", "", 3, 1, false, 1, 0, 255, ""},
    };
    for (size_t i = 0; i < sizeof header / sizeof *header; i++) {
        struct signal s = header[i];
        s.multiplex = is_multiplexed && i == 1 ? "M " : "";
        print_signal(out, &s);
    }
}

/* The numbers of a word, each by its name. */
static void print_word_signals(FILE *out, const struct bus_word_part *parts,
                               const struct lm_canas_type *t, const char *multiplex)
{
    for (unsigned i = 0; i < BUS_WORD_PARTS && parts[i].name != NULL; i++) {
        const bool is_signed = t->kind == LM_CANAS_KIND_SIGNED;
        print_signal(out, &(struct signal){parts[i].name, multiplex, 4 + i * t->element_bytes,
                                           t->element_bytes, is_signed, parts[i].scale, 0, 0,
                                           parts[i].unit});
    }
}

static void print_type_signals(FILE *out, const struct lm_bus_row *row, int type,
                               const char *multiplex)
{
    const char *unit = unit_of(row)->bus_unit;
    const struct lm_canas_type *t = &lm_canas_types[type];
    char name[DBC_NAME_BYTES];
    snprintf(name, sizeof name, "as_%s", t->name);
    const struct bus_word_part *parts_of_word = bus_word_parts(row->field);
    if (parts_of_word != NULL) {
        print_word_signals(out, parts_of_word, t, multiplex);
    } else if (type == LM_CANAS_SHORT2) {
        print_signal(out,
                     &(struct signal){"value_SHORT2", multiplex, 4, 2, true, 1, -32768, 32767, ""});
        print_signal(
            out, &(struct signal){"full_scale_SHORT2", multiplex, 6, 2, true, 1, 1, 32767, unit});
    } else if (t->elements >= 3) {
        static const char *const parts[] = {"hours", "minutes", "seconds"};
        for (unsigned i = 0; i < 3; i++) {
            char part[DBC_NAME_BYTES];
            snprintf(part, sizeof part, "%s_%s", parts[i], t->name);
            print_signal(out, &(struct signal){part, multiplex, 4 + i, 1, false, 1, 0,
                                               i == 0 ? 23 : 60, ""});
        }
    } else if (t->kind == LM_CANAS_KIND_HALF) {
        print_signal(out, &(struct signal){name, multiplex, 4, 4, false, 1, 0, 0, ""});
    } else {
        const bool is_unsigned = t->kind == LM_CANAS_KIND_UNSIGNED;
        const double scale = t->kind == LM_CANAS_KIND_FLOAT ? 1 : 1.0 / row->per_unit;
        print_signal(out, &(struct signal){name, multiplex, 4, t->element_bytes, !is_unsigned,
                                           scale, row->low, row->high, unit});
    }
}

static void print_canas_message(FILE *out, const struct lm_bus_profile *profile, int index)
{
    const struct lm_bus_row *row = &profile->rows[index];
    fprintf(out, "\nBO_ %u ", row->id);
    print_name(out, row->name, index);
    fprintf(out, ": 8 Vector__XXX\n");
    print_header_signals(out, !profile->are_types_assumed);
    for (int type = 0; type < LM_CANAS_TYPES; type++) {
        char multiplex[8] = "";
        if (!profile->are_types_assumed) {
            snprintf(multiplex, sizeof multiplex, "m%d ", type);
        }
        if (row->types >> type & 1) {
            print_type_signals(out, row, type, multiplex);
        }
    }
}

/* A number, or bytes that have names. All but the header is there only if the type is not NODATA.
 */
static void print_report_message(FILE *out, const struct lm_report_row *row, int index,
                                 const char *sender)
{
    const struct lm_canas_type *t = &lm_canas_types[row->type];
    char multiplex[8], name[DBC_NAME_BYTES];
    snprintf(multiplex, sizeof multiplex, "m%u ", row->type);
    fprintf(out, "\nBO_ %u display_", row->id);
    print_name(out, row->name, index);
    fprintf(out, ": 8 %s\n", sender);
    print_header_signals(out, true);
    const char *word = row->unit;
    for (unsigned i = 0; i < t->elements; i++) {
        const int length = (int)strcspn(word, " ");
        snprintf(name, sizeof name, t->elements == 1 ? "value" : "%.*s", length, word);
        const bool is_signed = t->kind == LM_CANAS_KIND_SIGNED;
        print_signal(out, &(struct signal){name, multiplex, 4 + i * t->element_bytes,
                                           t->element_bytes, is_signed, 1.0 / row->per_unit, 0,
                                           is_signed ? 0 : 255, t->elements == 1 ? word : ""});
        word += length + (word[length] == ' ');
    }
}

/* The display's own frames. */
static void print_service_messages(FILE *out)
{
    fprintf(out, "\nBO_ 128 node_service_request: 8 Vector__XXX\n");
    print_header_signals(out, false);
    fprintf(out, "\nBO_ 129 node_service_response: 8 landmass\n");
    print_header_signals(out, false);
    fprintf(out, "\nBO_ 1500 display_state: 8 landmass\n");
    print_header_signals(out, false);
    fprintf(out, " SG_ flags : 39|32@0+ (1,0) [0|4294967295] \"\" Vector__XXX\n");
    for (int i = 0; i < LM_REPORT_ITEMS; i++) {
        print_report_message(out, &lm_report_rows[i], i, "landmass");
    }
    for (int i = 0; i < LM_CONTROL_ITEMS; i++) {
        const struct lm_report_row row = bus_control_row(i);
        print_report_message(out, &row, i, i == LM_CONTROL_ITEM_STEP ? "landmass" : "Vector__XXX");
    }
    const struct lm_report_row swap = bus_swap_row();
    print_report_message(out, &swap, 0, "Vector__XXX"); /* it tells and hears them */
}

static bool are_one_frame(const struct lm_bus_row *a, const struct lm_bus_row *b)
{
    return a->id == b->id && a->packing.mask == b->packing.mask;
}

/* Where a number of a fast packet lies among its frames: frame 0 has six bytes of the message
 * behind two of its own, the others seven behind one. */
struct fast_place {
    unsigned frame, last_frame;
    struct lm_bus_bits bits; /* in its frame, if that is the last as well */
};

static unsigned fast_frame_of(unsigned byte)
{
    return byte < 6 ? 0 : (byte - 6) / 7 + 1;
}

static struct fast_place fast_place_of(const struct lm_bus_packing *p)
{
    const unsigned byte = p->bits.first / 8u, end = p->bits.first + p->bits.count - 1u;
    struct fast_place place = {fast_frame_of(byte), fast_frame_of(end / 8), p->bits};
    const unsigned at = place.frame == 0 ? byte + 2 : (byte - 6) % 7 + 1;
    place.bits.first = (uint16_t)(at * 8 + p->bits.first % 8u);
    return place;
}

/* A .dbc file knows no messages of several frames: a number that lies in two of them is left out.
 */
static bool is_in_dbc(const struct lm_bus_profile *profile, int index)
{
    if (profile->framing != LM_BUS_PACKED || !profile->rows[index].packing.is_fast) {
        return true;
    }
    const struct fast_place place = fast_place_of(&profile->rows[index].packing);
    return place.frame == place.last_frame;
}

static bool is_first_of_frame(const struct lm_bus_profile *profile, int index)
{
    for (int i = 0; i < index; i++) {
        if (are_one_frame(&profile->rows[i], &profile->rows[index])) {
            return false;
        }
    }
    return true;
}

/* The bits that decide between numbers of a frame: those of its first row that has a condition, or
 * a run of none. Another condition in the same frame is only said in a remark. */
static struct lm_bus_bits multiplexor_of(const struct lm_bus_profile *profile, int index)
{
    for (int i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        if (are_one_frame(row, &profile->rows[index]) && row->packing.match.count != 0) {
            return row->packing.match;
        }
    }
    return (struct lm_bus_bits){0, 0};
}

static void print_packed_signal(FILE *out, const struct lm_bus_row *row, int index,
                                struct lm_bus_bits multiplexor)
{
    const struct lm_bus_packing *p = &row->packing;
    fprintf(out, " SG_ ");
    print_name(out, row->name, index);
    if (p->match.count != 0 && p->match.first == multiplexor.first &&
        p->match.count == multiplexor.count) {
        fprintf(out, " m%u", p->match_value);
    }
    fprintf(out, " : %u|%u@%d%c (%.12g,%.8g) [%d|%d] \"%s\" Vector__XXX\n",
            dbc_start(p->bits, p->is_little_endian), p->bits.count, p->is_little_endian,
            p->type == LM_BUS_UNSIGNED ? '+' : '-', scale_of(row), offset_of(row), row->low,
            row->high, unit_of(row)->bus_unit);
}

/* The frames of a fast packet: the number of the frame decides which bytes of the message it has.
 */
static void print_fast_signals(FILE *out, const struct lm_bus_profile *profile, int index)
{
    fprintf(out,
            " SG_ sequence : 5|3@1+ (1,0) [0|7] \"\" Vector__XXX\n"
            " SG_ frame M : 0|5@1+ (1,0) [0|31] \"\" Vector__XXX\n"
            " SG_ message_bytes m0 : 8|8@1+ (1,0) [0|223] \"\" Vector__XXX\n");
    for (int i = index; i < profile->row_count; i++) {
        struct lm_bus_row row = profile->rows[i];
        if (are_one_frame(&row, &profile->rows[index]) && is_in_dbc(profile, i)) {
            const struct fast_place place = fast_place_of(&row.packing);
            row.packing.bits = place.bits;
            row.packing.match = (struct lm_bus_bits){0, 5};
            row.packing.match_value = (uint8_t)place.frame;
            print_packed_signal(out, &row, i, row.packing.match);
        }
    }
}

static void print_packed_message(FILE *out, const struct lm_bus_profile *profile, int index)
{
    const struct lm_bus_row *first = &profile->rows[index];
    const struct lm_bus_bits m = multiplexor_of(profile, index);
    fprintf(out, "\nBO_ %u ", first->id | CAN_EFF_FLAG);
    print_name(out, first->name, index);
    fprintf(out, ": 8 Vector__XXX\n");
    if (first->packing.is_fast) {
        print_fast_signals(out, profile, index);
        return;
    }
    if (m.count != 0) {
        fprintf(out, " SG_ when M : %u|%u@%d+ (1,0) [0|%u] \"\" Vector__XXX\n",
                dbc_start(m, first->packing.is_little_endian), m.count,
                first->packing.is_little_endian, (1u << m.count) - 1);
    }
    for (int i = index; i < profile->row_count; i++) {
        if (are_one_frame(&profile->rows[i], first)) {
            print_packed_signal(out, &profile->rows[i], i, m);
        }
    }
}

static unsigned dbc_id(const struct lm_bus_profile *profile, const struct lm_bus_row *row)
{
    return profile->framing == LM_BUS_PACKED ? row->id | CAN_EFF_FLAG : row->id;
}

/* Which signals are IEEE 754: 1 single, 2 double. */
static void print_float(FILE *out, const struct lm_bus_profile *profile, int index)
{
    const struct lm_bus_row *row = &profile->rows[index];
    if (profile->framing == LM_BUS_PACKED && row->packing.type == LM_BUS_FLOAT) {
        fprintf(out, "SIG_VALTYPE_ %u ", dbc_id(profile, row));
        print_name(out, row->name, index);
        fprintf(out, " : %d;\n", row->packing.bits.count / 32);
    } else if (row->types >> LM_CANAS_FLOAT & 1) {
        fprintf(out, "SIG_VALTYPE_ %u as_FLOAT : 1;\n", row->id);
    }
}

static void print_remarks(FILE *out, const struct lm_bus_profile *profile, int index)
{
    const struct lm_bus_row *row = &profile->rows[index];
    const struct lm_bus_packing *p = &row->packing;
    const unsigned id = dbc_id(profile, row);
    if (profile->framing == LM_BUS_CANAEROSPACE) {
        fprintf(out, "CM_ BO_ %u \"%s: field %s, priority %u, stale %u ms, dead %u ms\";\n", id,
                row->name, lm_bus_fields[row->field].name, row->priority, row->stale_ms,
                row->dead_ms);
        return;
    }
    if (!is_in_dbc(profile, index)) {
        return;
    }
    fprintf(out, "CM_ SG_ %u ", id);
    print_name(out, row->name, index);
    fprintf(out, " \"field %s, priority %u, stale %u ms, dead %u ms, identifier mask %08X",
            lm_bus_fields[row->field].name, row->priority, row->stale_ms, row->dead_ms, p->mask);
    if (p->match.count != 0) {
        fprintf(out, "; only when bits %u+%u are %u", p->match.first, p->match.count,
                p->match_value);
    }
    fprintf(out, "\";\n");
}

/* The numbers of a fast packet that lie in two frames, in one remark of the message. */
static void print_split(FILE *out, const struct lm_bus_profile *profile, int index)
{
    const char *before = "";
    for (int i = index; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        if (!are_one_frame(row, &profile->rows[index]) || is_in_dbc(profile, i)) {
            continue;
        }
        const struct fast_place place = fast_place_of(&row->packing);
        if (*before == '\0') {
            fprintf(out, "CM_ BO_ %u \"", dbc_id(profile, row));
        }
        fprintf(out, "%s%s: bits %u to %u of the message, in its frames %u to %u", before,
                row->name, row->packing.bits.first,
                row->packing.bits.first + row->packing.bits.count - 1u, place.frame,
                place.last_frame);
        before = "; ";
    }
    if (*before != '\0') {
        fprintf(out, "\";\n");
    }
}

static void print_values(FILE *out, const struct lm_bus_row *row)
{
    fprintf(out, "VAL_ %u data_type 0 \"NODATA\" 1 \"ERROR\"", row->id);
    for (int type = 2; type < LM_CANAS_TYPES; type++) {
        if (row->types >> type & 1) {
            fprintf(out, " %d \"%s\"", type, lm_canas_types[type].name);
        }
    }
    fprintf(out, " ;\n");
}

void bus_print_dbc(FILE *out, const struct lm_bus_profile *profile)
{
    const bool is_packed = profile->framing == LM_BUS_PACKED;
    fprintf(out, "VERSION \"landmass %s\"\n\nNS_ :\n\nBS_:\n\nBU_: landmass\n", profile->name);
    if (!is_packed) {
        print_service_messages(out);
    }
    for (int i = 0; i < profile->row_count; i++) {
        if (!is_packed) {
            print_canas_message(out, profile, i);
        } else if (is_first_of_frame(profile, i)) {
            print_packed_message(out, profile, i);
        }
    }
    fprintf(out, "\n");
    for (int i = 0; i < profile->row_count; i++) {
        print_remarks(out, profile, i);
        if (is_packed && is_first_of_frame(profile, i)) {
            print_split(out, profile, i);
        }
    }
    fprintf(out,
            "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
            "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n");
    for (int i = 0; i < profile->row_count; i++) {
        if (!is_packed || is_first_of_frame(profile, i)) {
            fprintf(out, "BA_ \"GenMsgCycleTime\" BO_ %u %u;\n", dbc_id(profile, &profile->rows[i]),
                    profile->rows[i].period_us / 1000);
        }
    }
    for (int i = 0; !is_packed && i < profile->row_count; i++) {
        print_values(out, &profile->rows[i]);
    }
    for (int i = 0; i < profile->row_count; i++) {
        if (is_in_dbc(profile, i)) {
            print_float(out, profile, i);
        }
    }
}
