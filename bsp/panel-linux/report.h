/* Reports of the panel, one line each, on standard error, which systemd gives to the journal. They
 * allocate nothing and do not wait for the journal, so the loop may use them. */
#ifndef PANEL_REPORT_H
#define PANEL_REPORT_H

/* Severity, numbered as in syslog. */
enum report_level { REPORT_ERROR = 3, REPORT_WARNING = 4, REPORT_NOTICE = 5, REPORT_INFO = 6 };

/* Print "landmass-panel: " and a message of place, cause and remedy, formatted as by printf. At
 * most 400 bytes. */
void report(enum report_level level, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
