#include "solver/loop/neighbour_list.hpp"

#include "solver/loop/row.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <numeric>

namespace slurry {

namespace {

constexpr std::size_t longest_ranked = 256;

// Each entry's place is the number of smaller ones. For a list of a kernel's neighbours this beats sorting by
// comparison many times over: there is no branch to mispredict.
void sort_by_rank(std::span<std::uint32_t> list) {
    constexpr std::size_t lanes = native_lanes<std::uint32_t>;
    using Indices = Pack<std::uint32_t, lanes>;
    std::array<std::uint32_t, longest_ranked> unsorted{};
    std::array<std::uint32_t, longest_ranked> ranks;
    std::copy(list.begin(), list.end(), unsorted.begin());
    for (std::size_t k = 0; k < list.size(); k += lanes) {
        const auto mine = load<Indices>(unsorted.data() + k);
        Indices smaller{};
        for (std::size_t other = 0; other < list.size(); ++other) {
            smaller += (unsorted[other] + Indices{}) < mine ? Indices{} + 1 : Indices{};
        }
        store(ranks.data() + k, smaller);
    }
    const std::size_t count = list.size();
    for (std::size_t k = 0; k < count; ++k) {
        list[ranks[k]] = unsorted[k];
    }
}

// Particles are sorted nearly as a search finds them: most lists are in order already.
void sort_ascending(std::span<std::uint32_t> list) {
    std::uint32_t descents = 0;
    for (std::size_t k = 1; k < list.size(); ++k) {
        descents += list[k - 1] > list[k] ? 1 : 0;
    }
    if (descents == 0) {
        return;
    }
    if (list.size() <= longest_ranked) {
        sort_by_rank(list);
    } else {
        std::sort(list.begin(), list.end());
    }
}

// Writes `count` entries, times `scale`, for each of eight lists, padded, eight side by side every `stride`.
// Reads up to seven entries beyond the end of a list.
void interleave_eight(const NeighbourLists& lists, std::size_t first, std::size_t count, std::size_t stride,
                      std::uint32_t padding, std::uint32_t scale, std::uint32_t* to) {
    using Indices = Pack<std::uint32_t, 8>;
    Indices lengths;
    std::array<const std::uint32_t*, 8> from;
    for (std::size_t lane = 0; lane < 8; ++lane) {
        from[lane] = lists.entries.data() + lists.begin(first + lane);
        lengths[lane] = static_cast<std::uint32_t>(lists.length(first + lane));
    }
    for (std::size_t k = 0; k < count; k += 8) {
        std::array<Indices, 8> tile;
        for (std::size_t lane = 0; lane < 8; ++lane) {
            std::memcpy(&tile[lane], from[lane] + (k < lengths[lane] ? k : 0), sizeof(Indices));
        }
        tile = detail::transpose8(tile);
        for (std::size_t row = k; row < std::min(k + 8, count); ++row) {
            const Indices number = static_cast<std::uint32_t>(row) + Indices{};
            store(to + row * stride,
                  Indices(number < lengths ? tile[row - k] * scale : padding * scale + Indices{}));
        }
    }
}

// The same for one list.
void interleave_one(const NeighbourLists& lists, std::size_t list, std::size_t count, std::size_t stride,
                    std::uint32_t padding, std::uint32_t scale, std::uint32_t* to) {
    const std::uint32_t* const from = lists.entries.data() + lists.begin(list);
    const std::size_t length = lists.length(list);
    for (std::size_t k = 0; k < count; ++k) {
        to[k * stride] = (k < length ? from[k] : padding) * scale;
    }
}

} // namespace

void NeighbourList::build(std::span<const double> x, std::span<const double> y,
                          std::span<const std::uint32_t> candidates, std::size_t first, std::size_t last,
                          std::uint32_t padding, double cutoff, double row_height) {
    const auto finder = make_finder(search_, {x, y, candidates, first, last, cutoff, row_height});
    const std::size_t block_count = (last - first + width_ - 1) / width_;
    first_ = first;
    last_ = last;
    padding_ = padding;
    blocks_.resize(block_count);
    chunks_.resize((block_count + chunk_blocks - 1) / chunk_blocks);
    const auto chunk_count = static_cast<std::ptrdiff_t>(chunks_.size());
    std::exception_ptr failure; // out of memory: no exception may leave a parallel region
#pragma omp parallel
    {
        NeighbourLists lists;
#pragma omp for schedule(static)
        for (std::ptrdiff_t signed_chunk = 0; signed_chunk < chunk_count; ++signed_chunk) {
            const auto chunk = static_cast<std::size_t>(signed_chunk);
            const std::size_t targets = chunk_blocks * width_;
            const std::size_t begin = first + chunk * targets;
            try {
                finder->find(begin, std::min(begin + targets, last), lists);
                fill_chunk(chunk, lists, padding);
            } catch (...) {
#pragma omp critical
                failure = std::current_exception();
            }
        }
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

void NeighbourList::fill_chunk(std::size_t chunk, NeighbourLists& lists, std::uint32_t padding) {
    const std::size_t first = chunk * chunk_blocks;
    const std::size_t last = std::min(first + chunk_blocks, blocks_.size());
    lists.ends.resize((last - first) * width_,
                      lists.size()); // lanes beyond the last target have no neighbours
    lists.entries.resize(std::max(lists.entries.size(), lists.size() + 8));
    std::size_t size = 0;
    for (std::size_t block = first; block < last; ++block) {
        std::size_t longest = 0;
        for (std::size_t k = (block - first) * width_; k < (block - first + 1) * width_; ++k) {
            sort_ascending(lists.list(k));
            longest = std::max(longest, lists.length(k));
        }
        blocks_[block] = {static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(longest)};
        size += longest * width_;
    }
    auto& entries = chunks_[chunk].entries;
    if (entries.capacity() < size) {
        entries = std::vector<std::uint32_t>(size); // resize() would take twice as much
    }
    entries.resize(size);
    chunks_[chunk].pairs = lists.size();
    for (std::size_t block = first; block < last; ++block) {
        const auto [offset, count] = blocks_[block];
        const std::size_t list = (block - first) * width_;
        if (width_ % 8 == 0) {
            for (std::size_t lane = 0; lane < width_; lane += 8) {
                interleave_eight(lists, list + lane, count, width_, padding, stride_,
                                 entries.data() + offset + lane);
            }
        } else {
            for (std::size_t lane = 0; lane < width_; ++lane) {
                interleave_one(lists, list + lane, count, width_, padding, stride_,
                               entries.data() + offset + lane);
            }
        }
    }
}

std::size_t NeighbourList::pairs() const {
    return std::accumulate(chunks_.begin(), chunks_.end(), std::size_t{0},
                           [](std::size_t sum, const Chunk& chunk) { return sum + chunk.pairs; });
}

std::size_t NeighbourList::bytes() const {
    return std::accumulate(chunks_.begin(), chunks_.end(), blocks_.capacity() * sizeof(Block),
                           [](std::size_t sum, const Chunk& chunk) {
                               return sum + sizeof(Chunk) + chunk.entries.capacity() * sizeof(std::uint32_t);
                           });
}

std::size_t NeighbourList::evaluated() const {
    return std::accumulate(chunks_.begin(), chunks_.end(), std::size_t{0},
                           [](std::size_t sum, const Chunk& chunk) { return sum + chunk.entries.size(); });
}

} // namespace slurry
