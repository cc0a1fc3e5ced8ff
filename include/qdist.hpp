// qdist for C++17: the functions of qdist.h under one name for both scalar types, and solver memory as a value. Header only; it owns
// nothing beyond what its objects contain, throws nothing and allocates nothing.
//
//     qdist::Solver<double, 3, 64, 128> solver;
//     qdist_box_f64 box{{1, 2, 3}};
//     qdist_sphere_f64 ball{0.5};
//     auto a = qdist::body(box), b = qdist::body(ball);   // point at box and ball
//     b.translation[0] = 1.25;
//     auto depth = qdist::depth(solver, a, b);
//     if (depth.status == QDIST_OK) use(depth.lower, depth.upper, depth.normal);
#ifndef QDIST_HPP
#define QDIST_HPP

#include "qdist.h"

namespace qdist {

// A result of the C interface with the status of its call.
template <class Result>
struct Checked : Result {
    qdist_status status;
    explicit operator bool() const noexcept { return status == QDIST_OK; }
};

// The types and functions of one scalar.
template <class T>
struct Api;

// A solver of dimension N with its memory. Do not copy while a query runs.
template <class T, uint32_t N, uint32_t MaxVertices, uint32_t MaxFacets>
class Solver {
    static_assert(N >= 2 && N <= 6 && MaxVertices > N && MaxFacets >= 2 * N, "see QDIST_ERROR_DIMENSION and QDIST_ERROR_CAPACITY");

public:
    Solver() noexcept {
        qdist_solver *solver = nullptr;
        Api<T>::init(memory_, uint32_t{sizeof memory_}, N, MaxVertices, MaxFacets, &solver);
    }
    // The handle for the C interface; it is the memory's address, whatever copy this is.
    qdist_solver *get() noexcept { return reinterpret_cast<qdist_solver *>(memory_); }

private:
    alignas(QDIST_WORKSPACE_ALIGN) unsigned char memory_[Api<T>::bytes(N, MaxVertices, MaxFacets)];
};

#define QDIST_HPP_SCALAR(T, suffix, SUFFIX)                                                                                \
    template <>                                                                                                            \
    struct Api<T> {                                                                                                        \
        using Set = qdist_set_##suffix;                                                                                    \
        using Body = qdist_body_##suffix;                                                                                  \
        using Body2 = qdist_body2_##suffix;                                                                                \
        using Unit = qdist_unit_##suffix;                                                                                \
        using Options = qdist_options_##suffix;                                                                            \
        using Depth = qdist_depth_##suffix;                                                                                \
        using Result = qdist_result_##suffix;                                                                              \
        static constexpr uint32_t bytes(uint32_t n, uint32_t vertices, uint32_t facets) noexcept {                         \
            return QDIST_WORKSPACE_BYTES_##SUFFIX(n, vertices, facets);                                                    \
        }                                                                                                                  \
        template <class... Args>                                                                                           \
        static qdist_status init(Args... args) noexcept {                                                                  \
            return qdist_solver_init_##suffix(args...);                                                                    \
        }                                                                                                                  \
        template <uint32_t N, class... Args>                                                                               \
        static qdist_status solve(Args... args) noexcept {                                                                 \
            if constexpr (N == 2) return qdist_solve2_##suffix(args...);                                                   \
            else if constexpr (N == 3) return qdist_solve3_##suffix(args...);                                              \
            else if constexpr (N == 4) return qdist_solve4_##suffix(args...);                                              \
            else if constexpr (N == 5) return qdist_solve5_##suffix(args...);                                              \
            else return qdist_solve6_##suffix(args...);                                                                    \
        }                                                                                                                  \
        static qdist_status depth(qdist_solver *solver, const Body *a, const Body *b, const Options *options,              \
                                  Depth *result) noexcept {                                                                \
            return qdist_depth3_##suffix(solver, a, b, options, result);                                                   \
        }                                                                                                                  \
        static qdist_status depth(qdist_solver *solver, const Body2 *a, const Body2 *b, const Options *options,            \
                                  Depth *result) noexcept {                                                                \
            return qdist_depth2_##suffix(solver, a, b, options, result);                                                   \
        }                                                                                                                  \
        static Options options() noexcept {                                                                                \
            Options options;                                                                                               \
            qdist_options_default_##suffix(&options);                                                                      \
            return options;                                                                                                \
        }                                                                                                                  \
    };                                                                                                                     \
    QDIST_HPP_BODY(suffix, sphere)                                                                                         \
    QDIST_HPP_BODY(suffix, box)                                                                                            \
    QDIST_HPP_BODY(suffix, ellipsoid)                                                                                      \
    QDIST_HPP_BODY(suffix, cylinder)                                                                                       \
    QDIST_HPP_BODY(suffix, capsule)                                                                                        \
    QDIST_HPP_BODY(suffix, cone)                                                                                           \
    QDIST_HPP_BODY(suffix, points)                                                                                         \
    QDIST_HPP_BODY(suffix, hull)                                                                                           \
    QDIST_HPP_BODY(suffix, hull_large)                                                                                     \
    QDIST_HPP_BODY(suffix, set)                                                                                            \
    QDIST_HPP_BODY(suffix, half_space)                                                                                     \
    QDIST_HPP_BODY(suffix, join)                                                                                           \
    QDIST_HPP_BODY2(suffix, disc, disc)                                                                                    \
    QDIST_HPP_BODY2(suffix, box, box2)                                                                                     \
    QDIST_HPP_BODY2(suffix, ellipse, ellipse)                                                                              \
    QDIST_HPP_BODY2(suffix, capsule, capsule2)                                                                             \
    QDIST_HPP_BODY2(suffix, points, points)                                                                                \
    QDIST_HPP_BODY2(suffix, set, set)                                                                                      \
    QDIST_HPP_BODY2(suffix, half_plane, half_plane)                                                                        \
    QDIST_HPP_BODY2(suffix, join, join2)                                                                                   \
    QDIST_HPP_SET(suffix)

// A body of a shape, in the identity pose; it points at the shape. A wrong shape gives a body that every query
// refuses, with the status that tells why in `status`.
#define QDIST_HPP_BODY(suffix, shape)                                                                                      \
    inline Checked<qdist_body_##suffix> body(const qdist_##shape##_##suffix &s) noexcept {                                 \
        Checked<qdist_body_##suffix> b{};                                                                                  \
        b.status = qdist_body_##shape##_##suffix(&b, &s);                                                                  \
        return b;                                                                                                          \
    }                                                                                                                      \
    void body(const qdist_##shape##_##suffix &&) = delete;

// The same for a body in the plane.
#define QDIST_HPP_BODY2(suffix, name, shape)                                                                               \
    inline Checked<qdist_body2_##suffix> body2(const qdist_##shape##_##suffix &s) noexcept {                               \
        Checked<qdist_body2_##suffix> b{};                                                                                 \
        b.status = qdist_body2_##name##_##suffix(&b, &s);                                                                  \
        return b;                                                                                                          \
    }                                                                                                                      \
    void body2(const qdist_##shape##_##suffix &&) = delete;

// The same for a set of points of any dimension.
#define QDIST_HPP_SET(suffix)                                                                                              \
    inline Checked<qdist_set_##suffix> set(const qdist_points_##suffix &points) noexcept {                                 \
        Checked<qdist_set_##suffix> s{};                                                                                   \
        s.status = qdist_set_points_##suffix(&s, &points);                                                                 \
        return s;                                                                                                          \
    }                                                                                                                      \
    void set(const qdist_points_##suffix &&) = delete;

QDIST_HPP_SCALAR(double, f64, F64)
QDIST_HPP_SCALAR(float, f32, F32)

#undef QDIST_HPP_SET
#undef QDIST_HPP_BODY2
#undef QDIST_HPP_BODY
#undef QDIST_HPP_SCALAR

template <class T>
typename Api<T>::Options options() noexcept {
    return Api<T>::options();
}

// Depth or distance of two bodies. `options` may be null.
template <class T, uint32_t V, uint32_t F>
Checked<typename Api<T>::Depth> depth(Solver<T, 3, V, F> &solver, const typename Api<T>::Body &a,
                                      const typename Api<T>::Body &b,
                                      const typename Api<T>::Options *options = nullptr) noexcept {
    Checked<typename Api<T>::Depth> result{};
    result.struct_size = sizeof(typename Api<T>::Depth);
    result.status = Api<T>::depth(solver.get(), &a, &b, options, &result);
    return result;
}

// The same in the plane.
template <class T, uint32_t V, uint32_t F>
Checked<typename Api<T>::Depth> depth(Solver<T, 2, V, F> &solver, const typename Api<T>::Body2 &a,
                                      const typename Api<T>::Body2 &b,
                                      const typename Api<T>::Options *options = nullptr) noexcept {
    Checked<typename Api<T>::Depth> result{};
    result.struct_size = sizeof(typename Api<T>::Depth);
    result.status = Api<T>::depth(solver.get(), &a, &b, options, &result);
    return result;
}

// Depth of the origin in a set; `q` null: with respect to the unit ball. `options` may be null.
template <class T, uint32_t N, uint32_t V, uint32_t F>
Checked<typename Api<T>::Result> solve(Solver<T, N, V, F> &solver, const typename Api<T>::Set &a,
                                       const typename Api<T>::Unit *q = nullptr,
                                       const typename Api<T>::Options *options = nullptr) noexcept {
    Checked<typename Api<T>::Result> result{};
    result.struct_size = sizeof(typename Api<T>::Result);
    result.status = Api<T>::template solve<N>(solver.get(), &a, q, options, static_cast<typename Api<T>::Result *>(&result));
    return result;
}

}  // namespace qdist

#endif
