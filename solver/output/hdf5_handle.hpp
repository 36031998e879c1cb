#pragma once
// Ownership of HDF5 identifiers, and HDF5's errors in words.
#include <hdf5.h>

#include <string>
#include <utility>

namespace slurry {

class Hdf5Handle {
  public:
    using Close = herr_t (*)(hid_t);

    Hdf5Handle() = default;
    Hdf5Handle(hid_t identifier, Close closer) : identifier_(identifier), close_(closer) {}
    ~Hdf5Handle() { close(); }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    Hdf5Handle(Hdf5Handle&& other) noexcept : identifier_(other.release()), close_(other.close_) {}
    Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
        std::swap(identifier_, other.identifier_);
        std::swap(close_, other.close_);
        return *this;
    }

    [[nodiscard]] hid_t get() const { return identifier_; }
    // Gives up ownership.
    hid_t release() { return std::exchange(identifier_, H5I_INVALID_HID); }
    // Closes now, for callers who must know whether all went well; negative on failure.
    herr_t close() {
        const hid_t identifier = release();
        return identifier < 0 ? 0 : close_(identifier);
    }

  private:
    hid_t identifier_ = H5I_INVALID_HID;
    Close close_ = nullptr;
};

// While it lives HDF5 prints nothing to stderr by itself. Made before anything else of HDF5 is used, it also
// keeps HDF5 from closing at exit what Hdf5Writer had to leave open.
class Hdf5Silence {
  public:
    Hdf5Silence() {
        H5dont_atexit();
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Hdf5Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Hdf5Silence(const Hdf5Silence&) = delete;
    Hdf5Silence& operator=(const Hdf5Silence&) = delete;

  private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

// Why the last HDF5 call failed: the system's reason ("No space left on device") where there is one, else
// HDF5's own.
std::string hdf5_reason();

} // namespace slurry
