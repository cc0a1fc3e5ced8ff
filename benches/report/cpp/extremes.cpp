// Extreme sets, unit sets and grasps: what qdist answers in every rounding mode, beside what is known of the truth in quadruple precision.
//
//     extremes COUNT        for every extreme COUNT random instances: extreme,value,scalar,mode,outcome,lower,upper,least,most,size,proved
//
// least <= d <= most is the truth: from a closed form where there is one; else most is the lowest h_A(u) / h_Q(u) that a search of its own found, in numbers of 34
// digits, and least is not known (nan). `proved` is h_A(u) / h_Q(u) of the direction u that qdist proves its upper bound with. `size` is what widths are shares of.

#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "../../../ffi-tests/dice.h"
#include "environment.hpp"
#include "qdist_grasp.h"

namespace {

using Real = __float128;
using Wide = std::vector<Real>;

Real dot(const Wide &a, const Wide &b) {
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

// ------------------------------------------------------------------------------------------------------------ both scalars

// The C API of a scalar, under one name.
template <class T>
struct Api;
#define API(real, suffix)                                                                                                          \
    template <>                                                                                                                    \
    struct Api<real> {                                                                                                             \
        using Set = qdist_set_##suffix;                                                                                            \
        using Unit = qdist_unit_##suffix;                                                                                          \
        using Box = qdist_box_unit_##suffix;                                                                                       \
        using Cross = qdist_cross_unit_##suffix;                                                                                   \
        using Ellipsoid = qdist_ellipsoid_unit_##suffix;                                                                           \
        using Contact = qdist_contact_##suffix;                                                                                    \
        using Frame = qdist_wrench_frame_##suffix;                                                                                 \
        using Primitive = qdist_primitive_##suffix;                                                                                \
        using Wrenches = qdist_wrenches_##suffix;                                                                                  \
        using Options = qdist_options_##suffix;                                                                                    \
        using Result = qdist_result_##suffix;                                                                                      \
        static constexpr const char *NAME = #suffix;                                                                               \
        static constexpr auto box = qdist_unit_box_##suffix;                                                                       \
        static constexpr auto cross = qdist_unit_cross_##suffix;                                                                   \
        static constexpr auto ellipsoid = qdist_unit_ellipsoid_##suffix;                                                           \
        static constexpr auto primitives = qdist_primitives_##suffix;                                                              \
        static constexpr auto wrenches = qdist_set_wrenches_##suffix;                                                              \
        static constexpr auto defaults = qdist_options_default_##suffix;                                                           \
        static qdist_status solve(int n, qdist_solver *solver, const Set *a, const Unit *q, const Options *options, Result *result) { \
            return n == 3 ? qdist_solve3_##suffix(solver, a, q, options, result) : qdist_solve6_##suffix(solver, a, q, options, result); \
        }                                                                                                                          \
        static qdist_status init(void *memory, std::size_t size, int n, qdist_solver **solver) {                                   \
            return qdist_solver_init_##suffix(memory, size, static_cast<uint32_t>(n), 64, 2048, solver);                           \
        }                                                                                                                          \
    };
API(double, f64)
API(float, f32)

uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)];
constexpr const char *MODES[] = {"nearest", "ftz", "up", "down", "zero"};

// ---------------------------------------------------------------------------------------------------------------- instances

// What is asked: A and Q for the library, and their support functions in 34 digits.
template <class T>
struct Instance {
    int n = 6;
    typename Api<T>::Set a{};
    typename Api<T>::Unit q{};
    bool ball = true;
    Real least = nanq(""), most = nanq(""), size = 1;

    virtual ~Instance() = default;
    virtual Real height(const Wide &u) const = 0;  // h_A
    virtual Wide farthest(const Wide &u) const = 0;
    virtual Real surely(const Wide &u) const { return height(u); }  // where A may be one of two sets: of the smaller one
    virtual Real unit(const Wide &u) const { return sqrtq(dot(u, u)); }  // h_Q
};

// A box or a cross-polytope of semi axes a, moved by c; with a ball around it.
template <class T>
struct Solid : Instance<T> {
    bool crossed = false;
    std::vector<T> axes, center, unit_axes;
    char kind = 'o';  // of Q: ball, box, cross-polytope, ellipsoid
    T radius = 0;
    typename Api<T>::Box box{};
    typename Api<T>::Cross cross{};
    typename Api<T>::Ellipsoid ellipsoid{};

    static int32_t support(void *user, const T *u, T *p) {
        const Solid &self = *static_cast<const Solid *>(user);
        int best = 0;
        for (int i = 1; i < self.n; ++i)
            if (self.axes[i] * std::fabs(u[i]) > self.axes[best] * std::fabs(u[best])) best = i;
        for (int i = 0; i < self.n; ++i) p[i] = self.center[i] + (self.crossed && i != best ? T(0) : std::copysign(self.axes[i], u[i]));
        return 0;
    }
    Wide farthest(const Wide &u) const override {
        Wide p(this->n);
        int best = 0;
        for (int i = 1; i < this->n; ++i)
            if (axes[i] * fabsq(u[i]) > axes[best] * fabsq(u[best])) best = i;
        for (int i = 0; i < this->n; ++i) p[i] = Real(center[i]) + (crossed && i != best ? Real(0) : copysignq(axes[i], u[i]));
        return p;
    }
    Real height(const Wide &u) const override { return dot(farthest(u), u) + radius * sqrtq(dot(u, u)); }
    Real unit(const Wide &u) const override {
        Real sum = 0, most = 0, squares = 0;
        for (int i = 0; i < this->n; ++i) {
            const Real x = fabsq(u[i]) * (kind == 'o' ? T(1) : unit_axes[i]);
            sum += x, most = std::max(most, x), squares += x * x;
        }
        return kind == 'b' ? sum : kind == 'x' ? most : sqrtq(squares);
    }
    // d in closed form: of a box along its faces' normals; of a cross-polytope around the origin sum |x_i| / a_i <= 1 / d for all x in Q.
    void know() {
        Real d = 1e4000Q, sum = 0, most = 0, squares = 0;
        for (int i = 0; i < this->n; ++i) {
            const Real q = kind == 'o' ? T(1) : unit_axes[i], x = q / axes[i];
            d = std::min(d, (Real(axes[i]) - fabsq(center[i]) + radius) / q);
            sum += x, most = std::max(most, x), squares += x * x;
        }
        if (crossed) d = 1 / (kind == 'b' ? sum : kind == 'x' ? most : sqrtq(squares));
        this->least = this->most = this->size = d;
    }
    void describe() {
        this->a.support = support, this->a.user = this, this->a.radius = radius, this->a.dimension = static_cast<uint32_t>(this->n);
        this->ball = kind == 'o';
        box.dimension = cross.dimension = ellipsoid.dimension = static_cast<uint32_t>(this->n);
        for (int i = 0; i < this->n && !this->ball; ++i) box.half[i] = cross.semi_axes[i] = ellipsoid.semi_axes[i] = unit_axes[i];
        const qdist_status status = kind == 'b'   ? Api<T>::box(&this->q, &box)
                                    : kind == 'x' ? Api<T>::cross(&this->q, &cross)
                                    : kind == 'e' ? Api<T>::ellipsoid(&this->q, &ellipsoid)
                                                  : QDIST_OK;
        if (status) std::abort();
        know();
    }
};

// Contacts, each with given tangents: h(u) = sum or max of cap (g1 + sqrt(mu^2 (g2^2 + g3^2) + mus^2 g4^2)) (Zheng and Yamane, Section II).
template <class T>
struct Grasp : Instance<T> {
    std::vector<typename Api<T>::Contact> contacts;
    std::vector<typename Api<T>::Primitive> primitives;
    typename Api<T>::Frame frame{};
    typename Api<T>::Wrenches wrenches{};
    bool sum = true;
    bool doubtful = false;  // the joints' rank: the spin moment is the joints', or it is not

    Real of_contact(const typename Api<T>::Contact &c, const Wide &u, Wide &point, bool spin = true) const {
        Real columns[4][6], g[4];
        const T *axes[4] = {c.normal, c.tangents, c.tangents + 3, c.normal};
        for (int k = 0; k < 4; ++k) {
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, l = (i + 2) % 3;
                columns[k][i] = k < 3 ? Real(axes[k][i]) : Real(0);
                columns[k][3 + i] = (k < 3 ? Real(c.position[j]) * axes[k][l] - Real(c.position[l]) * axes[k][j] : Real(axes[k][i])) / frame.torque_scale;
            }
            g[k] = 0;
            for (int i = 0; i < 6; ++i) g[k] += columns[k][i] * u[i];
        }
        const Real radii[4] = {0, c.mu, c.mu, spin && c.friction == QDIST_SOFT ? c.mus : T(0)};
        Real friction = 0;
        for (int k = 1; k < 4; ++k) friction += radii[k] * radii[k] * g[k] * g[k];
        friction = sqrtq(friction);
        for (int i = 0; i < 6; ++i) {
            point[i] = columns[0][i];
            for (int k = 1; k < 4 && friction > 0; ++k) point[i] += columns[k][i] * radii[k] * radii[k] * g[k] / friction;
        }
        return g[0] + friction;
    }
    Wide farthest(const Wide &u) const override { return farthest(u, true); }
    Real surely(const Wide &u) const override { return std::max(Real(0), dot(farthest(u, !doubtful), u)); }
    Wide farthest(const Wide &u, bool spin) const {
        Wide all(6, 0), one(6);
        Real most = 0;
        for (const auto &c : contacts) {
            const Real h = of_contact(c, u, one, spin);
            if (sum && h > 0)
                for (int i = 0; i < 6; ++i) all[i] += one[i];
            if (!sum && h > most) most = h, all = one;
        }
        return all;
    }
    Real height(const Wide &u) const override { return std::max(Real(0), dot(farthest(u), u)); }
    void describe() {
        primitives.resize(contacts.size());
        wrenches.primitives = primitives.data(), wrenches.count = static_cast<uint32_t>(contacts.size());
        wrenches.norm = sum ? QDIST_LINF : QDIST_L1;
        uint32_t which = 0;
        if (Api<T>::primitives(contacts.data(), wrenches.count, &frame, doubtful ? 1 : 0, 0, primitives.data(), &which) || Api<T>::wrenches(&this->a, &wrenches)) std::abort();
    }
};

// ------------------------------------------------------------------------------------------------------------ the search

// The lowest h_A / h_Q that steps along the subgradient find, from `u` with steps of this size at first.
template <class T>
Real descended(const Instance<T> &of, Wide u, Real step) {
    Real best = 1e4000Q;
    for (int k = 0; k < 40; ++k, step *= 0.65Q) {
        const Real length = sqrtq(dot(u, u));
        for (Real &x : u) x /= length;
        const Real value = of.height(u) / of.unit(u);
        best = std::min(best, value);
        Wide slope = of.farthest(u);
        const Real along = dot(slope, u);
        for (std::size_t i = 0; i < u.size(); ++i) slope[i] -= along * u[i];
        const Real steep = sqrtq(dot(slope, slope));
        if (!(steep > 0)) break;
        for (std::size_t i = 0; i < u.size(); ++i) u[i] -= step * slope[i] / steep;
    }
    return best;
}

template <class T>
void asked(const char *extreme, const std::string &value, const Instance<T> &of) {
    struct Said {
        const char *mode, *outcome;
        T lower, upper;
        Real proved;
    };
    std::vector<Said> all;
    Real most = of.most;
    if (isnanq(most)) {
        most = 1e4000Q;
        for (int k = 0; k < 6; ++k) {
            double u[6];
            random_direction(u, of.n);
            most = std::min(most, descended(of, Wide(u, u + of.n), 0.5Q));
        }
    }
    for (const char *mode : MODES) {
        qdist_solver *solver;
        typename Api<T>::Options options{};
        typename Api<T>::Result result{};
        result.struct_size = sizeof result;
        if (Api<T>::init(memory, sizeof memory, of.n, &solver) || Api<T>::defaults(&options)) std::abort();
        options.max_iterations = 1000;
        qdist_status status;
        {
            const Mode held(mode);
            status = Api<T>::solve(of.n, solver, &of.a, of.ball ? nullptr : &of.q, &options, &result);
        }
        if (status) {
            all.push_back({mode, qdist_status_string(status), T(NAN), T(NAN), nanq("")});
            continue;
        }
        const Wide u(result.direction, result.direction + of.n);
        const Real proved = of.surely(u) / of.unit(u);
        if (isnanq(of.most) && dot(u, u) > 0.5Q) most = std::min({most, of.height(u) / of.unit(u), descended(of, u, 1e-3Q)});
        all.push_back({mode, qdist_outcome_string(result.outcome), result.lower, result.upper, proved});
    }
    for (const Said &said : all) {
        char text[5][48];
        const Real numbers[] = {of.least, most, of.size, said.proved};
        for (int i = 0; i < 4; ++i) quadmath_snprintf(text[i], sizeof text[i], "%.25Qe", numbers[i]);
        std::printf("%s,%s,%s,%s,%s,%.17g,%.17g,%s,%s,%s,%s\n", extreme, value.c_str(), Api<T>::NAME, said.mode, said.outcome, double(said.lower), double(said.upper),
                    text[0], text[1], text[2], text[3]);
    }
}

// ---------------------------------------------------------------------------------------------------------------- the extremes

template <class T>
std::unique_ptr<Solid<T>> solid(int n, bool crossed, char kind, double aspect, double margin) {
    auto made = std::make_unique<Solid<T>>();
    made->n = n, made->crossed = crossed, made->kind = kind, made->radius = static_cast<T>(margin);
    for (int i = 0; i < n; ++i) {
        made->axes.push_back(static_cast<T>(between(0.5, 2)));
        made->center.push_back(crossed ? T(0) : static_cast<T>(0.5 * dice() * made->axes[i]));
        made->unit_axes.push_back(static_cast<T>(i < 2 ? (i ? 1 : 1 / aspect) : 1 / decade(0, std::log10(aspect) + 1e-9)));
    }
    made->describe();
    return made;
}

// Fingertips on an ellipsoid, which press inward, `apart`: the normals of every second are those of the one before, turned by as much. `rank`: the joints' least singular
// value over the largest, of joints that make the spin moment.
template <class T>
std::unique_ptr<Grasp<T>> grasp(int count, double mu, double torque_scale, double apart, double rank = 0) {
    auto made = std::make_unique<Grasp<T>>();
    made->sum = dice() > 0;
    made->frame.torque_scale = static_cast<T>(torque_scale);
    const double axes[3] = {1, 0.75, 0.5};
    double z[3], p[3];
    for (int k = 0; k < count; ++k) {
        typename Api<T>::Contact contact{};
        const bool again = apart > 0 && k % 2 == 1;
        if (!again) random_direction(z, 3);
        double n[3], o[3], t[3], length = 0;
        for (int i = 0; i < 3; ++i) p[i] = axes[i] * z[i], n[i] = -z[i] / axes[i] + (again ? apart * dice() : 0);
        for (const double x : n) length += x * x;
        for (double &x : n) x /= std::sqrt(length);
        const int small = static_cast<int>(std::min_element(n, n + 3, [](double a, double b) { return std::fabs(a) < std::fabs(b); }) - n);
        double across = 0;
        for (int i = 0; i < 3; ++i) o[i] = (i == small ? 1 : 0) - n[small] * n[i], across += o[i] * o[i];
        for (double &x : o) x /= std::sqrt(across);
        for (int i = 0; i < 3; ++i) t[i] = n[(i + 1) % 3] * o[(i + 2) % 3] - n[(i + 2) % 3] * o[(i + 1) % 3];
        for (int i = 0; i < 3; ++i) {
            contact.position[i] = static_cast<T>(p[i]), contact.normal[i] = static_cast<T>(n[i]);
            contact.tangents[i] = static_cast<T>(o[i]), contact.tangents[3 + i] = static_cast<T>(t[i]);
        }
        contact.mu = static_cast<T>(mu), contact.mus = static_cast<T>(0.3 * mu);
        contact.friction = dice() > 0 || rank > 0 ? QDIST_SOFT : QDIST_HARD;
        contact.actuated = rank > 0, contact.joints = rank > 0 ? 4 : 0;
        for (int k = 0; k < 4; ++k) contact.jacobian[8 * k + k] = static_cast<T>(k < 3 ? 1 : rank * (1 + 0.1 * dice()));
        made->contacts.push_back(contact);
    }
    made->doubtful = rank > 0;
    made->describe();
    return made;
}

std::string power(int exponent) { return "1e" + std::to_string(exponent); }

template <class T>
void all(int count) {
    // (The same instances for both scalars, but for their rounding.)
    const bool single = sizeof(T) == sizeof(float);
    for (const int exponent : {2, 4, 8})
        for (int k = 0; k < count; ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * exponent);
            asked("axes of Q: longest over shortest", power(exponent), *solid<T>(k % 2 ? 3 : 6, k % 4 > 1, "bxe"[k % 3], std::pow(10, exponent), 0));
        }
    for (const int exponent : {-12, -6, 0, 6})
        for (int k = 0; k < count; ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * (20 + exponent));
            asked("ball swept over a box: radius", power(exponent), *solid<T>(k % 2 ? 3 : 6, false, 'o', 1, std::pow(10, exponent)));
        }
    for (const int exponent : {-6, -3, 3, 6})
        for (int k = 0; k < count; ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * (40 + exponent));
            asked("torque scale of a grasp", power(exponent), *grasp<T>(3 + k % 4, 0.5, std::pow(10, exponent), 0));
        }
    for (const int exponent : {-9, -4, 1, 2})
        for (int k = 0; k < count; ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * (60 + exponent));
            asked("friction of a grasp", power(exponent), *grasp<T>(exponent < 0 ? 10 : 3 + k % 4, std::pow(10, exponent), 1, 0));
        }
    for (const int times : {-2, -1, 0, 1})
        for (int k = 0; k < count; ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * (100 + times));
            asked("hands: rank tolerance times", power(times), *grasp<T>(4 + k % 3, 0.5, 1, 0, (single ? 4e-6 : 1e-9) * std::pow(10, times)));
        }
    for (const int exponent : {-12, -9, -6, -3})
        for (int k = 0; k < count && !(single && exponent < -9); ++k) {
            dice_state = static_cast<uint64_t>(1 + k + 1000 * (80 + exponent));
            asked("contact normals apart by", power(exponent), *grasp<T>(6 + 2 * (k % 2), 0.5, 1, std::pow(10, exponent)));
        }
}

}  // namespace

int main(int argc, char **argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 20;
    std::puts("extreme,value,scalar,mode,outcome,lower,upper,least,most,size,proved");
    all<double>(count);
    all<float>(count);
}
