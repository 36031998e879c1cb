#include "solver/output/xdmf.hpp"

#include <gtest/gtest.h>

#include <array>

namespace slurry {
namespace {

TEST(Xdmf, DescribesEachSnapshotAsAPointCloudInTime) {
    const std::array<XdmfSnapshot, 2> snapshots{
        {{"/snapshots/0000", 0.0, 7}, {"/snapshots/0001", 2.5e-5, 9}}};
    const std::string text = xdmf_document("a < b & \"c\"", "result.h5", snapshots);
    for (const char* part :
         {R"(<Grid Name="a &lt; b &amp; &quot;c&quot;" GridType="Collection" CollectionType="Temporal">)",
          R"(<Time Value="2.5e-05"/>)",
          R"(<Topology TopologyType="Polyvertex" NumberOfElements="9" NodesPerElement="1"/>)",
          R"(Dimensions="9 3">result.h5:/snapshots/0001/position</DataItem></Geometry>)",
          R"(<Attribute Name="velocity" AttributeType="Vector" Center="Node">)",
          R"(NumberType="Int" Precision="4" Dimensions="7">result.h5:/snapshots/0000/wall</DataItem>)"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

} // namespace
} // namespace slurry
