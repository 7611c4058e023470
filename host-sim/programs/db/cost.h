/* What a command took, for plans of many of them. */
#ifndef DB_COST_H
#define DB_COST_H

/* Seconds of a clock that nobody sets. */
double db_cost_seconds(void);

/* Print and report what the process took: seconds, seconds of a processor, memory. */
void db_cost_report(double seconds);

#endif
