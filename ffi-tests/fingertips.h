/* A grasp that is closed: four soft fingertips on the unit ball. */
#ifndef FINGERTIPS_H
#define FINGERTIPS_H

#include "qdist_grasp.h"
#include <string.h>

enum { TIPS = 4 };

static inline void four_fingertips(qdist_contact_f64 *tips) {
    static const double normals[TIPS][3] = {{0.6, 0.8, 0}, {-0.6, 0.8, 0}, {0, -0.6, 0.8}, {0, -0.6, -0.8}};
    memset(tips, 0, TIPS * sizeof *tips);
    for (int i = 0; i < TIPS; i++) {
        for (int k = 0; k < 3; k++) tips[i].normal[k] = normals[i][k], tips[i].position[k] = -normals[i][k];
        tips[i].friction = QDIST_SOFT, tips[i].mu = 0.5, tips[i].mus = 0.1;
    }
}

#endif
