#include "sim/track_log.h"

#include "hs/report.h"

#include <math.h>
#include <stdio.h>

static const char *const kinds[] = {"none", "FTT", "GMTT", "AGR"};
static const char *const states[] = {"off", "searching", "held", "coasting"};
static const char *const losses[LM_TRACK_LOSSES] = {
    [LM_TRACK_SOUND] = "none",        [LM_TRACK_SILENT] = "silent",
    [LM_TRACK_NO_NAV] = "navigation", [LM_TRACK_LIMITS] = "limits",
    [LM_TRACK_SHADOW] = "shadow",     [LM_TRACK_WEAK] = "weak",
    [LM_TRACK_NOTCH] = "notch",       [LM_TRACK_NOTHING] = "nothing there",
};

static void add_gap(struct track_log_item *t, enum lm_track_loss loss, double now_s)
{
    if (t->gaps < TRACK_LOG_GAPS) {
        t->gap[t->gaps] = (struct track_log_gap){now_s, loss};
    }
    t->gaps++;
}

static void follow(struct track_log_item *t, const struct lm_track *track, double now_s)
{
    const enum lm_track_state state = (enum lm_track_state)track->state;
    if (state == LM_TRACK_HELD) {
        t->held_s = isnan(t->held_s) ? now_s : t->held_s;
        t->slant_range_m = track->seen.slant_m_q8 / 256.0;
        t->range_rate_m_s = track->seen.range_rate_mm_s / 1000.0;
        t->speed_m_s = track->seen.speed_mm_s / 1000.0;
    } else if (t->state == LM_TRACK_HELD && state != LM_TRACK_OFF) {
        add_gap(t, (enum lm_track_loss)track->loss, now_s);
    }
    t->state = state;
    t->loss = (enum lm_track_loss)track->loss;
    t->ended_s = state == LM_TRACK_OFF ? now_s : (double)NAN;
}

void track_log_step(struct track_log *log, const struct lm_track *track, uint64_t now_us)
{
    const double now_s = (double)now_us * 1e-6;
    const bool is_new = track->number != log->begun;
    struct track_log_item *last = log->count > 0 ? &log->item[log->count - 1] : NULL;
    if (is_new && last && last->state != LM_TRACK_OFF) { /* another took its place */
        last->state = LM_TRACK_OFF;
        last->ended_s = now_s;
    }
    if (is_new && log->count == TRACK_LOG_MAX) {
        log->left_out++;
    } else if (is_new) {
        last = &log->item[log->count++];
        *last = (struct track_log_item){.kind = (enum lm_track_kind)track->kind,
                                        .state = LM_TRACK_SEARCHING,
                                        .begun_s = now_s,
                                        .held_s = (double)NAN,
                                        .ended_s = (double)NAN,
                                        .slant_range_m = (double)NAN,
                                        .range_rate_m_s = (double)NAN,
                                        .speed_m_s = (double)NAN};
    }
    log->begun = track->number;
    if (last && log->left_out == 0 && (is_new || last->state != LM_TRACK_OFF)) {
        follow(last, track, now_s);
    }
}

static void print_item(const struct track_log_item *t)
{
    printf("     %s from %.2f s", kinds[t->kind], t->begun_s);
    if (isnan(t->held_s)) {
        printf(": never held");
    } else {
        printf(", held from %.2f s, last at %.0f m and %.1f m/s", t->held_s, t->slant_range_m,
               t->speed_m_s);
    }
    for (unsigned i = 0; i < t->gaps && i < TRACK_LOG_GAPS; i++) {
        printf("; no return at %.2f s: %s", t->gap[i].at_s, losses[t->gap[i].loss]);
    }
    if (t->gaps > TRACK_LOG_GAPS) {
        printf("; %u more times", t->gaps - TRACK_LOG_GAPS);
    }
    if (t->state == LM_TRACK_OFF) {
        printf("; over at %.2f s: %s\n", t->ended_s,
               t->loss == LM_TRACK_SOUND ? "ended" : losses[t->loss]);
    } else {
        printf("; at the end %s\n", states[t->state]);
    }
}

void track_log_print(const struct track_log *log)
{
    if (log->count == 0) {
        return;
    }
    printf("tracks: %u begun\n", log->count + log->left_out);
    for (unsigned i = 0; i < log->count; i++) {
        print_item(&log->item[i]);
    }
}

static void report_item(const struct track_log_item *t)
{
    hs_report_object(NULL);
    hs_report_text("kind", kinds[t->kind]);
    hs_report_text("state", states[t->state]);
    hs_report_text("loss", losses[t->loss]);
    hs_report_real("begun_s", t->begun_s);
    hs_report_real("held_s", t->held_s);
    hs_report_real("ended_s", t->ended_s);
    hs_report_real("slant_range_m", t->slant_range_m);
    hs_report_real("range_rate_m_s", t->range_rate_m_s);
    hs_report_real("speed_m_s", t->speed_m_s);
    hs_report_count("gaps", t->gaps);
    hs_report_array("breaks");
    for (unsigned i = 0; i < t->gaps && i < TRACK_LOG_GAPS; i++) {
        hs_report_object(NULL);
        hs_report_real("at_s", t->gap[i].at_s);
        hs_report_text("loss", losses[t->gap[i].loss]);
        hs_report_close();
    }
    hs_report_close();
    hs_report_close();
}

void track_log_report(const struct track_log *log)
{
    hs_report_count("tracks_begun", log->count + log->left_out);
    hs_report_array("tracks");
    for (unsigned i = 0; i < log->count; i++) {
        report_item(&log->item[i]);
    }
    hs_report_close();
}
