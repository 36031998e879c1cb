#pragma once
// Neighbours of consecutive targets, interleaved for the pair loop: block b holds targets b W ... b W + W -
// 1, and entry k of lane l is its k-th neighbour. Short lanes are padded with a row that is far away.
#include "solver/loop/neighbour_search.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace slurry {

class NeighbourList {
  public:
    // A list for blocks of `width` targets. An entry is an index times `stride`: the offset of a row in
    // bytes, so that the pair loop need not multiply.
    NeighbourList(int width, NeighbourSearch search, std::size_t stride = 1)
        : width_(static_cast<std::size_t>(width)), search_(search),
          stride_(static_cast<std::uint32_t>(stride)) {}

    // Lists for the targets first ... last - 1 of the points (x, y) all candidates nearer than the cut-off,
    // themselves excepted, in ascending order: neither the search nor the number of threads changes a sum
    // over them. Candidates are indices into (x, y), each at most once; targets need not be candidates.
    // `row_height`: see SearchProblem.
    void build(std::span<const double> x, std::span<const double> y,
               std::span<const std::uint32_t> candidates, std::size_t first, std::size_t last,
               std::uint32_t padding, double cutoff, double row_height = 0);

    [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }
    // Offset of a block's row; that of the padding beyond the last target.
    [[nodiscard]] std::uint32_t target(std::size_t block, std::size_t lane) const {
        const std::size_t target = first_ + block * width_ + lane;
        return static_cast<std::uint32_t>(target < last_ ? target : padding_) * stride_;
    }
    [[nodiscard]] const std::uint32_t* neighbours(std::size_t block) const {
        return chunks_[block / chunk_blocks].entries.data() + blocks_[block].first;
    }
    // Entries per lane, padding included.
    [[nodiscard]] std::size_t count(std::size_t block) const { return blocks_[block].count; }

    // Neighbours in all lists, and entries that a pair loop goes through for them: padding included.
    [[nodiscard]] std::size_t pairs() const;
    [[nodiscard]] std::size_t evaluated() const;
    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::size_t chunk_blocks = 64;

    struct Block {
        std::uint32_t first, count; // in its chunk's entries; per lane
    };
    // The entries of consecutive blocks. Each chunk has its own, so that a crowded one makes no other longer
    // and threads need not know of each other's.
    struct Chunk {
        std::vector<std::uint32_t> entries;
        std::size_t pairs = 0;
    };

    void fill_chunk(std::size_t chunk, NeighbourLists& lists, std::uint32_t padding);

    std::size_t width_;
    NeighbourSearch search_;
    std::uint32_t stride_;
    std::size_t first_ = 0, last_ = 0, padding_ = 0;
    std::vector<Block> blocks_;
    std::vector<Chunk> chunks_;
};

} // namespace slurry
