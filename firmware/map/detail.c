#include "lm/detail.h"

#include <stdbool.h>

#include "fx/crc32c.h"
#include "lm/db.h"
#include "lm/status.h"

_Static_assert(sizeof(struct lm_detail) == LM_DETAIL_HEAD_BYTES + LM_DETAIL_ITEMS_MAX * 16,
               "items follow the head");

static bool item_is_sound(const struct lm_detail_item *item)
{
    const bool is_line = item->kind == LM_DETAIL_LINE;
    const bool is_surface = item->kind == LM_DETAIL_SURFACE;
    return item->kind >= LM_DETAIL_BLOCK && item->kind < LM_DETAIL_KINDS &&
           item->class_number < LM_DB_CLASS_NONE && item->length_dm != 0 && item->width_dm != 0 &&
           (!is_line || item->glint_code >= item->gamma_code) &&
           (!is_surface || (item->glint_code <= 1 && item->height_dm >> LM_DB_CLASS_NONE == 0));
}

int lm_detail_check(const struct lm_detail *detail, uint32_t bytes, uint8_t lod, uint32_t row,
                    uint32_t column)
{
    if (bytes < LM_DETAIL_HEAD_BYTES || bytes > LM_DETAIL_BYTES_MAX ||
        bytes % LM_DETAIL_UNIT_BYTES != 0 ||
        detail->count > (bytes - LM_DETAIL_HEAD_BYTES) / LM_DETAIL_ITEM_BYTES ||
        detail->lod != lod || detail->row != row || detail->column != column ||
        fx_crc32c(0, (const uint8_t *)detail + 4, bytes - 4) != detail->crc) {
        return LM_ERR_CORRUPT;
    }
    for (uint32_t i = 0; i < detail->count; i++) {
        if (!item_is_sound(&detail->items[i])) {
            return LM_ERR_CORRUPT;
        }
    }
    return LM_OK;
}
