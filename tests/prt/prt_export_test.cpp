// SPDX-License-Identifier: Apache-2.0
// What .npy and .ply files made of a .prt file hold.
#include "prt/prt_export.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <sstream>

#include "core/error.h"
#include "prt/mesh_normals.h"
#include "prt/prt_key.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

class PrtExported : public testing::Test {
  protected:
    PrtExported() {
        MeshReport ignored;
        compute_normals(mesh_, {}, ignored);
        header_ = some_header(mesh_.positions.size());
        header_.tables.push_back({PrtKind::bent_normal, PrtType::float32});
        header_.mesh = mesh_key(mesh_);
        header_.block_rows = 7;
    }
    PrtReader reader() {
        write_prt(directory_ / "a.prt", header_);
        return PrtReader(directory_ / "a.prt");
    }
    std::string message(const PrtReader& file) {
        try {
            write_prt_ply(file, PrtKind::transfer, mesh_, "a.obj", directory_ / "a.ply");
        } catch (const Error& error) {
            return error.describe();
        }
        return {};
    }

    const ScratchDirectory directory_;
    Mesh mesh_ = make_globe(3);
    PrtHeader header_;
};

// The rules of NumPy's format 1.0, one by one.
TEST_F(PrtExported, NpyFollowsTheRulesOfItsHeader) {
    const PrtReader file = reader();
    for (const auto& [kind, words] :
         {std::pair(PrtKind::transfer, "{'descr': '<f4', 'fortran_order': False, 'shape': (20, 4)"),
          {PrtKind::ray_count, "{'descr': '<u4', 'fortran_order': False, 'shape': (20, 1)"}}) {
        write_prt_npy(file, kind, directory_ / "a.npy", true);
        const std::string bytes = read_bytes(directory_ / "a.npy");
        EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
        const std::size_t length = detail::load_unsigned(bytes.data() + 8, 2, false);
        EXPECT_EQ((10 + length) % 64, 0u);
        const std::string text = bytes.substr(10, length);
        EXPECT_EQ(text.rfind(words, 0), 0u) << text;
        EXPECT_EQ(text.back(), '\n');
        EXPECT_EQ(text.find_first_not_of(' ', text.find('}') + 1), length - 1);
        const std::size_t components = file.components(kind);
        ASSERT_EQ(bytes.size(), 10 + length + 4 * 20 * components);
        const char* data = bytes.data() + 10 + length;
        std::vector<std::uint32_t> numbers(20 * components);
        if (kind == PrtKind::ray_count) {
            file.read(kind, 0, 20, numbers.data());
        } else {
            const std::vector<float> values = file.read_all(kind);
            std::transform(values.begin(), values.end(), numbers.begin(),
                           [](float value) { return detail::bits_of(value); });
        }
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            EXPECT_EQ(detail::load_unsigned(data + 4 * i, 4, false), numbers[i]);
        }
    }
}

TEST_F(PrtExported, NumpyReadsTheSame) {
    const std::string out = directory_ / "out";
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
        GTEST_SKIP() << "no NumPy here";
    }
    const PrtReader file = reader();
    write_prt_npy(file, PrtKind::visibility, directory_ / "a.npy");
    const std::string command =
        "/usr/bin/python3 -c 'import numpy, sys\n"
        "a = numpy.load(sys.argv[1])\n"
        "print(a.dtype.str, a.shape, a.flags.c_contiguous)\n"
        "for v in a.flat: print(float(v).hex())' '" +
        directory_ / "a.npy" + "' > '" + out + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::istringstream lines(read_bytes(out));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "<f4 (20, 4) True");
    for (const float value : file.read_all(PrtKind::visibility)) {
        ASSERT_TRUE(std::getline(lines, line));
        EXPECT_EQ(std::strtod(line.c_str(), nullptr), static_cast<double>(value)) << line;
    }
}

/// A vertex of a PLY as doubles, by the names of its properties.
std::vector<double> ply_column(const std::string& bytes, const std::string& wanted) {
    std::istringstream lines(bytes);
    std::size_t stride = 0, offset = 0, rows = 0;
    std::string type_wanted;
    bool vertices = false;
    for (std::string line; std::getline(lines, line) && line != "end_header";) {
        std::istringstream words(line);
        std::string word, type, name;
        words >> word >> type >> name;
        if (word == "element") vertices = type == "vertex";
        if (word == "element" && vertices) rows = std::stoul(name);
        if (word != "property" || !vertices) continue;
        if (name == wanted) {
            offset = stride;
            type_wanted = type;
        }
        stride += type == "double" ? 8 : type == "uchar" ? 1 : 4;
    }
    const char* data = bytes.data() + bytes.find("end_header\n") + 11;
    std::vector<double> column;
    for (std::size_t row = 0; row < rows; ++row) {
        const char* at = data + row * stride + offset;
        column.push_back(type_wanted == "double"  ? detail::load_double(at, false)
                         : type_wanted == "float" ? detail::load_float(at, false)
                         : type_wanted == "uchar" ? static_cast<unsigned char>(*at)
                                                  : NAN);
    }
    return column;
}

TEST_F(PrtExported, PlyIsTheMeshWithItsColoursAndCoefficients) {
    const PrtReader file = reader();
    write_prt_ply(file, PrtKind::transfer, mesh_, "a.obj", directory_ / "a.ply");
    const Mesh back = read_mesh(directory_ / "a.ply");
    EXPECT_EQ(back.positions, mesh_.positions);
    EXPECT_EQ(back.triangles, mesh_.triangles);
    for (std::size_t v = 0; v < back.normals.size(); ++v) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(back.normals[v][i], mesh_.normals[v][i], 1e-7);
    }
    const std::string bytes = read_bytes(directory_ / "a.ply");
    const std::vector<float> occlusion = file.read_all(PrtKind::ambient_occlusion),
                             transfer = file.read_all(PrtKind::transfer),
                             bent = file.read_all(PrtKind::bent_normal);
    const std::vector<double> quality = ply_column(bytes, "quality"),
                              red = ply_column(bytes, "red"), blue = ply_column(bytes, "blue"),
                              y = ply_column(bytes, "bent_y"),
                              last = ply_column(bytes, "transfer_3");
    ASSERT_EQ(quality.size(), 20u);
    for (std::size_t v = 0; v < 20; ++v) {
        EXPECT_EQ(quality[v], static_cast<double>(occlusion[v]));
        EXPECT_EQ(y[v], static_cast<double>(bent[3 * v + 1]));
        EXPECT_EQ(last[v], static_cast<double>(transfer[4 * v + 3]));
        const double linear = std::min(std::max(quality[v], 0.0), 1.0);
        const double back_to_linear = red[v] / 255 <= 0.04045
                                          ? red[v] / 255 / 12.92
                                          : std::pow((red[v] / 255 + 0.055) / 1.055, 2.4);
        // Half a step of 1/255 where the curve is least steep.
        EXPECT_NEAR(back_to_linear, linear, 0.0046);
        EXPECT_EQ(red[v], blue[v]);
    }
}

TEST_F(PrtExported, ShadeWithoutAmbientOcclusionIsThatOfAWhiteSky) {
    const std::vector<PrtTable> tables = {{PrtKind::visibility, PrtType::float32},
                                          {PrtKind::transfer, PrtType::float32}};
    for (const std::size_t count : {1, 2}) {
        header_.tables.assign(tables.begin(), tables.begin() + static_cast<std::ptrdiff_t>(count));
        const PrtKind kind = tables[count - 1].kind;
        const double pi = 3.14159265358979323846;
        // An open hemisphere: visibility is its integral, transfer that of the clamped cosine / pi.
        const double y00 = 0.5 / std::sqrt(pi);
        const auto open = static_cast<float>(kind == PrtKind::visibility ? 2 * pi * y00 : y00);
        PrtRows rows(header_);
        rows.values[count - 1].assign(80, open);
        PrtWriter writer(directory_ / "a.prt", header_, true);
        writer.append(20, rows.from(header_, 0));
        writer.finish();
        write_prt_ply(PrtReader(directory_ / "a.prt"), kind, mesh_, "a.obj", directory_ / "a.ply",
                      true);
        const std::string bytes = read_bytes(directory_ / "a.ply");
        EXPECT_NEAR(ply_column(bytes, "quality")[3], 1, 1e-6);
        EXPECT_EQ(ply_column(bytes, "green")[3], 255);
    }
}

TEST_F(PrtExported, PositionsOutOfReachOfFloatsAreDoubles) {
    for (const double scale : {1e-60, 1e-20, 1e20, 1e60}) {
        Mesh scaled = mesh_;
        for (glm::dvec3& position : scaled.positions) position *= scale;
        header_.mesh = mesh_key(scaled);
        write_prt_ply(reader(), PrtKind::transfer, scaled, "a.obj", directory_ / "a.ply", true);
        const std::vector<double> y = ply_column(read_bytes(directory_ / "a.ply"), "y");
        for (std::size_t v = 0; v < 20; ++v) {
            EXPECT_NEAR(y[v] / scale, mesh_.positions[v].y, 1e-7) << scale;
        }
    }
}

TEST_F(PrtExported, PlyIsOfTheBakedMeshAndOfAWholeFileAlone) {
    const auto refused = [&](const std::string& sentence, const PrtReader& file) {
        const std::string words = message(file);
        EXPECT_NE(words.find(sentence), std::string::npos) << words << "\n" << sentence;
        EXPECT_EQ(directory_.entries(), std::vector<std::string>{"a.prt"});
    };
    mesh_.positions[3].x += 1e-9;
    refused("a.obj: is not the mesh that " + (directory_ / "a.prt") + " is of: its key is ",
            reader());
    mesh_.positions.emplace_back(0, 0, 0);
    mesh_.normals.emplace_back(0, 1, 0);
    refused("a.obj: has 21 vertices, and ", reader());
    header_.shards = 3;
    header_.shard = 1;
    refused("a.prt: is part 2 of 3, and a PLY takes a whole file", reader());
    header_ = some_header(21);
    header_.mesh = mesh_key(mesh_);
    header_.tables = {{PrtKind::ray_count, PrtType::uint32}};
    refused("a.prt: holds no ambient_occlusion, transfer or visibility", reader());
    header_.tables = {{PrtKind::vertex_index, PrtType::uint32}};
    refused("a.prt: has rows in an order of its own", reader());
    header_.tables = {{PrtKind::visibility, PrtType::float32}};
    refused("a.prt: does not hold transfer", reader());
}

}  // namespace
}  // namespace airlight
