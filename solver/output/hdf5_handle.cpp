#include "solver/output/hdf5_handle.hpp"

#include <string_view>

namespace slurry {
namespace {

struct Reasons {
    std::string system;
    std::string innermost;
};

herr_t collect(unsigned /*depth*/, const H5E_error2_t* error, void* data) {
    auto& reasons = *static_cast<Reasons*>(data);
    const std::string_view text = error->desc == nullptr ? "" : error->desc;
    // HDF5's file driver quotes strerror in this form; errno itself may have been overwritten since.
    constexpr std::string_view key = "error message = '";
    if (const auto at = text.find(key); at != std::string_view::npos && reasons.system.empty()) {
        const std::string_view quoted = text.substr(at + key.size());
        reasons.system = quoted.substr(0, quoted.find('\''));
    }
    if (reasons.innermost.empty())
        reasons.innermost = text;
    return 0;
}

} // namespace

std::string hdf5_reason() {
    Reasons reasons;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect, &reasons);
    if (!reasons.system.empty())
        return reasons.system;
    return reasons.innermost.empty() ? "HDF5 gives no reason" : reasons.innermost;
}

} // namespace slurry
