#include "solver/loop/packed_points.hpp"

#include "solver/loop/pack.hpp"

#if defined(__AVX512F__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace slurry {

namespace {

constexpr std::size_t lanes = native_lanes<double>;
using Numbers = Pack<double, lanes>;

// Writes the indices of those lanes that are near, among the first `count`, and not `self`; returns the end.
std::uint32_t* append_hits(const Numbers& squared, double squared_cutoff, const std::uint32_t* indices,
                           std::size_t count, std::uint32_t self, std::uint32_t* end) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
    const __m256i index = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(indices));
    const unsigned near =
        _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(squared), _mm512_set1_pd(squared_cutoff), _CMP_LT_OQ);
    const unsigned others = _mm256_cmpneq_epi32_mask(index, _mm256_set1_epi32(static_cast<int>(self)));
    const unsigned counted = count < lanes ? (1U << count) - 1 : 0xFF;
    const unsigned hits = near & others & counted;
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(end),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(hits), index));
    return end + __builtin_popcount(hits);
#else
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        *end = indices[lane];
        end += squared[lane] < squared_cutoff && indices[lane] != self && lane < count ? 1 : 0;
    }
    return end;
#endif
}

} // namespace

void PackedPoints::resize(std::size_t count) {
    x_.resize(count + lanes); // the last points are read as a whole vector, too
    y_.resize(count + lanes);
    index_.resize(count + lanes);
}

void PackedPoints::append_near(const Target& target, std::span<const Window> windows, double squared_cutoff,
                               NeighbourLists& lists) const {
    std::size_t room = lists.size() + lanes; // whole vectors are written, too
    for (const Window& window : windows) {
        room += window.last - window.first;
    }
    if (lists.entries.size() < room) {
        lists.entries.resize(2 * room);
    }
    const double* const xs = x_.data();
    const double* const ys = y_.data();
    const std::uint32_t* const indices = index_.data();
    std::uint32_t* end = lists.entries.data() + lists.size();
    for (const auto [first, last] : windows) {
        for (std::size_t slot = first; slot < last; slot += lanes) {
            const Numbers dx = target.x - load<Numbers>(xs + slot);
            const Numbers dy = target.y - load<Numbers>(ys + slot);
            const Numbers squared = dx * dx + dy * dy;
            end = append_hits(squared, squared_cutoff, indices + slot, last - slot, target.index, end);
        }
    }
    lists.ends.push_back(static_cast<std::size_t>(end - lists.entries.data()));
}

} // namespace slurry
