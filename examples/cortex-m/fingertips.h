/* Fingertips around an object the size of a hand: metres, newtons. */
#ifndef FINGERTIPS_H
#define FINGERTIPS_H

#include "measure.h"
#include "qdist_grasp.h"
#include "real.h"

enum { FINGERS = 3 };

static const Q(wrench_frame) FRAME = {{0, 0, 0}, (real)0.04};

/* Three of them, a third of a turn apart, each off its place by up to `off` in the direction of the skin and in height. */
static void touch(Q(contact) * contacts, qdist_friction friction, real off) {
    static const real directions[FINGERS][2] = {{1, 0}, {(real)-0.5, (real)0.8660254}, {(real)-0.5, (real)-0.8660254}};
    static const Q(contact) nowhere;
    for (int i = 0; i < FINGERS; ++i) {
        Q(contact) *const c = &contacts[i];
        const real x = directions[i][0], y = directions[i][1], aside = off * (real)dice(), up = off * (real)dice();
        *c = nowhere;
        c->normal[0] = -x, c->normal[1] = -y;
        c->position[0] = (real)0.04 * x - aside * y, c->position[1] = (real)0.04 * y + aside * x, c->position[2] = up;
        c->friction = friction, c->mu = (real)0.6, c->mus = (real)0.004;
    }
}

#endif
