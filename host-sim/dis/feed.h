/* Feed: the gateway's door for entities that did not come in PDUs of DIS. */
#ifndef DIS_FEED_H
#define DIS_FEED_H

#include "dis/gateway.h"

/* Take the state of an entity, of this instant. Its numbers are finite and near the Earth. */
void dis_gateway_take_entity(struct dis_gateway *g, const struct dis_entity_state *s,
                             int64_t now_us);

/* The one sender of all entities is heard: none of them is silent. */
void dis_gateway_hear_all(struct dis_gateway *g, int64_t now_us);

/* The counts, to add to. */
struct dis_counts *dis_gateway_tally(struct dis_gateway *g);

/* Mean sea level above the ellipsoid. */
double dis_sea_level_m(const struct dis_sea_level *sea, const struct dis_place *place);

#endif
