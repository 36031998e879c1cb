#include "solver/output/xdmf.hpp"

#include <fmt/format.h>

namespace slurry {
namespace {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char character : text) {
        switch (character) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += character;
        }
    }
    return result;
}

std::string data_item(std::string_view data, const XdmfSnapshot& snapshot, std::string_view quantity) {
    const bool vector = quantity == "position" || quantity == "velocity";
    const bool integer = quantity == "wall";
    return fmt::format(
        R"(<DataItem Format="HDF" NumberType="{}" Precision="{}" Dimensions="{}{}">{}:{}/{}</DataItem>)",
        integer ? "Int" : "Float", integer ? 4 : 8, snapshot.particles, vector ? " 3" : "", data,
        snapshot.group, quantity);
}

std::string grid(std::string_view data, const XdmfSnapshot& snapshot) {
    std::string text =
        fmt::format(R"(      <Grid Name="{0}" GridType="Uniform">
        <Time Value="{1}"/>
        <Topology TopologyType="Polyvertex" NumberOfElements="{2}" NodesPerElement="1"/>
        <Geometry GeometryType="XYZ">{3}</Geometry>
)",
                    snapshot.group, snapshot.time, snapshot.particles, data_item(data, snapshot, "position"));
    for (const std::string_view quantity : {"velocity", "pressure", "density", "volume", "wall"})
        text += fmt::format(
            "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", quantity,
            quantity == "velocity" ? "Vector" : "Scalar", data_item(data, snapshot, quantity));
    return text + "      </Grid>\n";
}

} // namespace

std::string xdmf_document(std::string_view title, std::string_view data,
                          std::span<const XdmfSnapshot> snapshots) {
    std::string text = fmt::format(R"(<?xml version="1.0" ?>
<Xdmf Version="2.0">
  <Domain>
    <Grid Name="{}" GridType="Collection" CollectionType="Temporal">
)",
                                   escaped(title.empty() ? "particles" : title));
    for (const XdmfSnapshot& snapshot : snapshots)
        text += grid(data, snapshot);
    return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

} // namespace slurry
