#include "tests/fuzz/checkpoint_edits.hpp"

#include "solver/output/hdf5_handle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace slurry::fuzz {
namespace {

using Sizes = std::vector<hsize_t>;

constexpr std::array<double, 14> edges{0,         -0.0,  -1,     1,        NAN,          INFINITY,
                                       -INFINITY, 1e308, -1e308, 4.9e-324, 2147483648.0, 4294967295.0,
                                       1e18,      1e-300};

herr_t note_object(hid_t /*file*/, const char* name, const H5O_info_t* /*object*/, void* to) {
    if (std::string_view(name) != ".") {
        static_cast<StoredNames*>(to)->objects.push_back(std::string("/") + name);
    }
    return 0;
}

void note_attributes(hid_t file, const std::string& object, StoredNames& names) {
    const Hdf5Handle owner(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
    const auto note = [](hid_t /*owner*/, const char* name, const H5A_info_t* /*attribute*/, void* to) {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return herr_t{0};
    };
    std::vector<std::string> found;
    H5Aiterate2(owner.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &found);
    for (std::string& name : found) {
        names.attributes.push_back({object, std::move(name)});
    }
}

Hdf5Handle text_type(std::size_t size) {
    Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), size);
    return type;
}

Hdf5Handle any_type(Bytes& bytes) {
    switch (bytes.below(6)) {
    case 0:
        return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    case 1:
        return {H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
    case 2:
        return {H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose};
    case 3:
        return text_type(5);
    case 4:
        return {H5Tvlen_create(H5T_NATIVE_DOUBLE), H5Tclose};
    default:
        return text_type(H5T_VARIABLE);
    }
}

Hdf5Handle any_space(Bytes& bytes) {
    static const std::array<Sizes, 7> shapes{
        Sizes{1}, Sizes{3}, Sizes{1000}, Sizes{2, 3}, Sizes{1, 1, 1}, Sizes{0}, Sizes{hsize_t{1} << 40U}};
    const std::size_t choice = bytes.below(shapes.size() + 2);
    if (choice >= shapes.size()) {
        return {H5Screate(choice == shapes.size() ? H5S_SCALAR : H5S_NULL), H5Sclose};
    }
    const Sizes& shape = shapes[choice];
    return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

// None where there are too many to write.
hssize_t points_in(const Hdf5Handle& space) {
    const hssize_t points = H5Sget_simple_extent_npoints(space.get());
    return points > hssize_t{1} << 16U ? 0 : std::max<hssize_t>(points, 0);
}

// Every number of a dataset, or one of them.
void set_numbers(hid_t file, const std::string& path, Bytes& bytes) {
    const Hdf5Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const auto points = static_cast<std::size_t>(points_in(space));
    if (dataset.get() < 0 || points == 0 || H5Sget_simple_extent_ndims(space.get()) != 1) {
        return;
    }
    if (bytes.below(2) == 0) {
        const std::vector<double> values(points, bytes.number());
        H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        return;
    }
    const hsize_t place = bytes.below(points);
    const double value = bytes.number();
    const Hdf5Handle single(H5Screate(H5S_SCALAR), H5Sclose);
    H5Sselect_elements(space.get(), H5S_SELECT_SET, 1, &place);
    H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, single.get(), space.get(), H5P_DEFAULT, &value);
}

void replace_object(hid_t file, const std::string& path, Bytes& bytes) {
    H5Ldelete(file, path.c_str(), H5P_DEFAULT);
    switch (bytes.below(5)) {
    case 0:
        return;
    case 1:
        Hdf5Handle(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose).close();
        return;
    case 2:
        H5Lcreate_soft(bytes.below(2) == 0 ? "/state" : path.c_str(), file, path.c_str(), H5P_DEFAULT,
                       H5P_DEFAULT);
        return;
    default:
        const Hdf5Handle type = any_type(bytes);
        const Hdf5Handle space = any_space(bytes);
        Hdf5Handle(
            H5Dcreate2(file, path.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose)
            .close();
    }
}

void replace_attribute(hid_t file, const StoredAttribute& which, Bytes& bytes) {
    const Hdf5Handle owner(H5Oopen(file, which.object.c_str(), H5P_DEFAULT), H5Oclose);
    H5Adelete(owner.get(), which.name.c_str());
    const bool expected = bytes.below(2) == 0; // of the shape that a reader looks for
    const bool number = bytes.below(2) == 0;
    const Hdf5Handle type = !expected ? any_type(bytes)
                            : number  ? Hdf5Handle(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose)
                                      : text_type(H5T_VARIABLE);
    const Hdf5Handle space = expected ? Hdf5Handle(H5Screate(H5S_SCALAR), H5Sclose) : any_space(bytes);
    const Hdf5Handle attribute(
        H5Acreate2(owner.get(), which.name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    const auto points = static_cast<std::size_t>(points_in(space));
    if (attribute.get() < 0 || points == 0) {
        return;
    }
    if (H5Tget_class(type.get()) != H5T_STRING) {
        const std::vector<double> values(points, bytes.number());
        H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, values.data());
    } else if (H5Tis_variable_str(type.get()) > 0) {
        const std::string text = bytes.text();
        const std::vector<const char*> texts(points, text.c_str());
        H5Awrite(attribute.get(), type.get(), texts.data());
    }
}

} // namespace

std::string Bytes::take(std::size_t count) {
    std::string taken(rest_.substr(0, count));
    rest_.remove_prefix(taken.size());
    taken.resize(count, '\0');
    return taken;
}

std::size_t Bytes::below(std::size_t count) {
    const std::string taken = take(count > 256 ? 2 : 1);
    std::size_t value = 0;
    for (const char byte : taken) {
        value = value * 256 + static_cast<unsigned char>(byte);
    }
    return value % count;
}

double Bytes::number() {
    const std::size_t choice = below(edges.size() + 2);
    if (choice < edges.size()) {
        return edges[choice];
    }
    const std::string taken = take(sizeof(double));
    double value = 0;
    std::memcpy(&value, taken.data(), sizeof(double));
    return value;
}

std::string Bytes::text() {
    return take(below(16));
}

StoredNames names_in(const std::filesystem::path& path) {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    StoredNames names;
    H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_INC, note_object, &names, H5O_INFO_BASIC);
    note_attributes(file.get(), "/", names);
    for (const std::string& object : names.objects) {
        note_attributes(file.get(), object, names);
    }
    return names;
}

void edit(hid_t file, const StoredNames& names, Bytes& bytes) {
    switch (bytes.below(3)) {
    case 0:
        return set_numbers(file, names.objects[bytes.below(names.objects.size())], bytes);
    case 1:
        return replace_object(file, names.objects[bytes.below(names.objects.size())], bytes);
    default:
        return replace_attribute(file, names.attributes[bytes.below(names.attributes.size())], bytes);
    }
}

} // namespace slurry::fuzz
