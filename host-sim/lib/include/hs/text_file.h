/* Text files read line by line, with the file and line at hand for messages. Usage: db_text_open,
 * db_text_next until it returns 0 or less, db_text_close. */
#ifndef HS_TEXT_FILE_H
#define HS_TEXT_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct db_text_file {
    FILE *stream;
    const char *path; /* borrowed */
    int line_number;
    char *line; /* owned; the current line without its remark and without space around it */
    size_t capacity;
    char remark[120]; /* what stood after '#' */
};

/* Returns 0, or -1 with the error reported: the file cannot be opened. */
int db_text_open(struct db_text_file *f, const char *path);

/* Step to the next line that holds more than a remark. Returns 1, 0 at the end of the file, or -1
 * with a read error reported. */
int db_text_next(struct db_text_file *f);

/* Report an error at the current line; returns -1. */
int db_text_error(const struct db_text_file *f, const char *remedy, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* Split "key = value" in place; returns 0, or -1 when there is no '=' or either side is empty. */
int db_text_split(char *line, char **key, char **value);

/* Split a line into words in place, at spaces and tabs. Returns their number, or most + 1 when
 * there are more than `most`; the entries of `words` behind the last are empty words. */
int db_text_words(char *line, char **words, int most);

/* Close the file and free the line. */
void db_text_close(struct db_text_file *f);

#endif
