#include "lm/radar_record.h"

#include "fx/crc32c.h"
#include "fx/mem.h"
#include "lm/radar_check.h"
#include "lm/status.h"

enum { AT_VERSION = 4, AT_BYTES = 6, AT_NAMES = 8 };

/* Place in a record while one of its parts after the other is copied. */
struct place {
    uint8_t *at;
    bool is_read; /* from the record into the table */
};

static void copy(struct place *p, void *of_table, uint32_t bytes)
{
    if (p->is_read) {
        memcpy(of_table, p->at, bytes);
    } else {
        memcpy(p->at, of_table, bytes);
    }
    p->at += bytes;
}

static void copy_names(struct place *p, struct lm_radar *radar)
{
    copy(p, radar->name, LM_RADAR_NAME_SIZE);
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        copy(p, radar->mode[i].name, LM_NAME_SIZE);
    }
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        copy(p, radar->fov[i].name, LM_NAME_SIZE);
    }
}

/* All elements, those of unused rows too. */
static void copy_numbers(struct place *p, struct lm_radar *radar)
{
    const struct lm_radar_field *field;
    for (uint32_t n = 0; (field = lm_radar_field(n)) != NULL; n++) {
        for (uint32_t i = 0; i < field->count; i++) {
            copy(p, (uint8_t *)radar + field->offset + (size_t)i * field->stride, field->size);
        }
    }
}

void lm_radar_pack(const struct lm_radar *radar, uint8_t *record)
{
    struct lm_radar table = *radar;
    struct place p = {record + AT_NAMES, false};
    const uint16_t version = LM_RADAR_RECORD_VERSION, bytes = LM_RADAR_RECORD_BYTES;
    copy_names(&p, &table);
    copy_numbers(&p, &table);
    memcpy(record + AT_VERSION, &version, sizeof version);
    memcpy(record + AT_BYTES, &bytes, sizeof bytes);
    const uint32_t crc = fx_crc32c(0, record + AT_VERSION, LM_RADAR_RECORD_BYTES - AT_VERSION);
    memcpy(record, &crc, sizeof crc);
}

/* The version stands at the same place in every version, and the rest may differ. */
static int check_head(const uint8_t *record, uint32_t bytes)
{
    if (bytes < AT_NAMES) {
        return LM_ERR_CORRUPT;
    }
    if (fx_load_u16(record + AT_VERSION) != LM_RADAR_RECORD_VERSION) {
        return LM_ERR_VERSION;
    }
    const bool is_sound = bytes == LM_RADAR_RECORD_BYTES &&
                          fx_load_u16(record + AT_BYTES) == bytes &&
                          fx_crc32c(0, record + AT_VERSION, LM_RADAR_RECORD_BYTES - AT_VERSION) ==
                              fx_load_u32(record);
    return is_sound ? LM_OK : LM_ERR_CORRUPT;
}

int lm_radar_unpack(struct lm_radar *radar, const uint8_t *record, uint32_t bytes)
{
    uint8_t own[LM_RADAR_RECORD_BYTES];
    struct place p = {own + AT_NAMES, true};
    const int status = check_head(record, bytes);
    if (status != LM_OK) {
        return status;
    }
    memcpy(own, record, sizeof own);
    memset(radar, 0, sizeof *radar);
    copy_names(&p, radar);
    copy_numbers(&p, radar);
    return lm_radar_check(radar, NULL);
}
