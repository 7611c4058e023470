/* Curves of a day: the temperature of each class as a table and as a chart. */
#ifndef DB_INFRARED_CURVES_H
#define DB_INFRARED_CURVES_H

#include "infrared/class_days.h"

/* Write infrared.csv and infrared.png into the folder: degrees Celsius of the mean of each class,
 * on level ground. `days` has one for each class. Returns 0, or -1 with the error reported. */
int infrared_curves_write(const char *folder, const struct db_class_table *table,
                          const struct ir_class_days *days);

#endif
