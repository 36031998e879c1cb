#pragma once
// The description of the snapshots in result.h5 that ParaView opens.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace slurry {

struct XdmfSnapshot {
    std::string group; // its path in the HDF5 file, "/snapshots/0000"
    double time;       // s
    std::size_t particles;
};

// A temporal collection of point clouds (XDMF 2 and 3) that refers to the file `data` beside it.
std::string xdmf_document(std::string_view title, std::string_view data,
                          std::span<const XdmfSnapshot> snapshots);

} // namespace slurry
