/* Architectures of reflection networks: those that Niu compares, EP1 to EP5 of Table III and Fig.
 * 17, EP6 to EP8 of Table IV; and EP9 to EP12 of ours, which are EP8 with other inputs. */
#ifndef NETEM_ARCHITECTURE_H
#define NETEM_ARCHITECTURE_H

#include "netem/network.h"
#include "tracer/records.h"

/* Inputs of a network for one reflection, each within -1..1: material, incident angle, angle of
 * the way out to the normal, angle between the ways in and out (Table I; paths.h makes them). */
enum { NM_INPUTS = 4 };

/* EP9's: the three angles; the angle between the normal and the bisector of both ways, which is 0
 * where a mirror would send the ray to the radar, and how near it is to 0; and one input for each
 * material, of which one is not 0, so that materials have no order. EP11 has more of these. */
enum { NM_ANGLE_INPUTS = 5, NM_FEW_NAMES = 32, NM_MANY_NAMES = TRACE_MATERIALS_MAX };

/* EP10's: EP9's angles, and what the material is made of (struct nm_surface), so that one network
 * knows all materials between those of its training. */
enum { NM_SURFACE_INPUTS = 4 };

/* EP12's: EP11's, and sine and cosine of the azimuth from which the radar looks at the target. What
 * is too small for the model looks another from every side. */
enum { NM_SIDE_INPUTS = 2 };

/* What a network is told of the material. */
enum nm_material_input { NM_AS_NUMBER, NM_AS_NAME, NM_AS_SURFACE, NM_AS_NAME_AND_SIDE };

/* How one reflection's network is connected with the next one's. */
enum nm_connection {
    NM_BY_COEFFICIENT, /* Fig. 11: outputs are coefficients, multiplied along a ray */
    NM_BY_INTENSITY,   /* Fig. 10: outputs are intensities; what arrives is one more input, the last
                        */
    NM_CONNECTIONS
};
extern const char *const nm_connection_names[NM_CONNECTIONS];

/* The same words for a table of options. */
#define NM_CONNECTION_WORDS "coefficient|intensity"

enum { NM_INPUTS_MAX = NM_ANGLE_INPUTS + NM_SIDE_INPUTS + NM_MANY_NAMES + 1 };

/* Fig. 17. */
enum nm_wiring {
    NM_ONE_OUTPUT,  /* (a) one network, asked once with the geometry of each direction */
    NM_TWO_OUTPUTS, /* (b) one network that gives both from the geometry of the echo */
    NM_TWO_NETWORKS /* (c) a network for each direction */
};

struct nm_architecture {
    const char *name; /* "EP1" to "EP12" */
    enum nm_wiring wiring;
    enum nm_connection connection;
    enum nm_material_input material;
    struct nm_network network; /* one of them, where there are two alike */
};

enum { NM_ARCHITECTURES = 12, NM_PAPERS = 8 }; /* the paper's come first */
extern const struct nm_architecture nm_architectures[NM_CONNECTIONS][NM_ARCHITECTURES];

/* NULL when there is no such name. */
const struct nm_architecture *nm_architecture_find(const char *name, enum nm_connection connection);

/* Materials that its networks can be told apart by name; all of them where they go otherwise. */
uint32_t nm_architecture_names(const struct nm_architecture *a);

/* Weights of all its networks together; those of the echo (BK) come first. */
size_t nm_architecture_size(const struct nm_architecture *a);

#endif
