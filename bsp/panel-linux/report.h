/* What the panel says about itself, one line each, on standard error: the journal's, where systemd
 * started it. Allocates nothing and does not wait for the journal, so that the loop may use it. */
#ifndef PANEL_REPORT_H
#define PANEL_REPORT_H

/* As syslog numbers them. */
enum report_level { REPORT_ERROR = 3, REPORT_WARNING = 4, REPORT_NOTICE = 5, REPORT_INFO = 6 };

/* Print "landmass-panel: ...": place, cause and remedy. At most 400 bytes; as for printf. */
void report(enum report_level level, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
