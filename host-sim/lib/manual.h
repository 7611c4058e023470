/* Pieces of a manual page in the language of man(7). */
#ifndef HS_MANUAL_H
#define HS_MANUAL_H

/* The head: names the page after the program and `command` (or ""), with its one-line `summary`. */
void manual_begin(const char *command, const char *summary);

/* `text` with what would be read as a command of the language escaped. */
void manual_text(const char *text);

/* Paragraphs: an empty line parts them, and lines that begin with a blank keep their form. */
void manual_paragraphs(const char *text);

/* Words filled anew; a line that begins with a blank begins a line there too. */
void manual_filled(const char *text);

/* What all programs promise. */
void manual_exit_status(void);

#endif
