// SPDX-License-Identifier: Apache-2.0
// What `airlight info` and `airlight export` do with .prt files.
#include <nlohmann/json.hpp>

#include "prt/prt_key.h"
#include "tests/cli/program.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/prt_bytes.h"

namespace airlight {
namespace {

class PrtCommand : public testing::Test {
  protected:
    PrtCommand() {
        write_bytes(mesh_, to_obj(make_globe(3)));
        header_ = some_header(20);
        header_.mesh = mesh_key(read_mesh(mesh_));
    }
    void write() { write_prt(path_, header_, "{\"name\": \"a\\nb\", \"rays traced\": 20480}"); }

    const ScratchDirectory directory_;
    const std::string mesh_ = directory_ / "a.obj";
    const std::string path_ = directory_ / "a.prt";
    PrtHeader header_;
};

TEST_F(PrtCommand, InfoTellsWhatItHolds) {
    header_.shard = 1;
    header_.shards = 3;
    header_.mesh_vertices = 60;
    header_.first_row = 20;
    write();
    const Outcome outcome = run({"info", path_, "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json file = nlohmann::json::parse(outcome.out)["files"][0];
    EXPECT_EQ(file["format"], "prt");
    EXPECT_EQ(file["order"], 2);
    EXPECT_EQ(file["mesh_vertices"], 60);
    EXPECT_EQ(file["first_row"], 20);
    EXPECT_EQ(file["rows"], 20);
    EXPECT_EQ(file["shard"], 1);
    EXPECT_EQ(file["shards"], 3);
    EXPECT_EQ(file["rays"], 1024);
    EXPECT_EQ(file["tolerance"], 0.001);
    EXPECT_EQ(file["key"], "01020300000000000000000000000000");
    EXPECT_EQ(file["file_bytes"], read_bytes(path_).size());
    EXPECT_EQ(file["report"]["rays traced"], 20480);
    ASSERT_EQ(file["tables"].size(), 4u);
    EXPECT_EQ(file["tables"][1]["kind"], "transfer");
    EXPECT_EQ(file["tables"][1]["type"], "float16");
    EXPECT_EQ(file["tables"][1]["components"], 4);
    EXPECT_GT(file["tables"][1]["rms_rounding_error"], 1e-6);
    EXPECT_EQ(file["tables"][0]["largest_rounding_error"], 0);

    const std::string text = run({"info", path_}).out;
    for (const char* part :
         {"radiance transfer, order 2, 60 vertices", "float16, 4 in a row", "2 of 3: 20 rows",
          "1024 for each vertex at most, to the tolerance 0.001", "report: rays traced"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    }
    EXPECT_NE(text.find("\"a\\nb\""), std::string::npos) << text;
    const Outcome piped = run({"info", "-", "--json"}, read_bytes(path_));
    ASSERT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(nlohmann::json::parse(piped.out)["files"][0]["fingerprint"], file["fingerprint"]);
}

TEST_F(PrtCommand, ExportWritesArraysAndColouredMeshes) {
    write();
    const std::string array = directory_ / "a.NPY", coloured = directory_ / "a.ply";
    ASSERT_EQ(run({"export", path_, "-o", array}).status, 0);
    EXPECT_NE(read_bytes(array).find("'shape': (20, 4)"), std::string::npos);
    ASSERT_EQ(run({"export", path_, "-o", array, "--kind", "ray_count", "--force"}).status, 0);
    EXPECT_NE(read_bytes(array).find("'<u4'"), std::string::npos);
    const Outcome outcome = run({"export", path_, "-o", coloured, "--mesh", mesh_});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_mesh(coloured).positions, read_mesh(mesh_).positions);
    EXPECT_NE(read_bytes(coloured).find("property float transfer_3\n"), std::string::npos);
}

TEST_F(PrtCommand, AnArrayOfAPartComesWithAWarning) {
    header_.shards = 3;
    header_.mesh_vertices = 60;
    write();
    const Outcome outcome = run({"export", path_, "-o", directory_ / "a.npy"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("rows for 20 of 60 vertices, from row 0"), std::string::npos)
        << outcome.err;
}

TEST_F(PrtCommand, BadFilesAreRefusedInOneSentence) {
    write();
    const std::string good = read_bytes(path_), out = directory_ / "a.npy";
    const auto refuse = [&](const std::string& bytes, const std::string& sentence) {
        write_bytes(path_, bytes);
        expect_failure({"info", path_}, 1, path_ + ": " + sentence);
        expect_failure({"export", path_, "-o", out, "--kind", "visibility"}, 1,
                       path_ + ": " + sentence);
        EXPECT_EQ(directory_.entries().size(), 2u);
    };
    refuse("", "is empty");
    refuse("solid a\n", "is no .prt file");
    refuse(good.substr(0, good.size() - 1), "is cut off or unfinished");
    std::string damaged = good;
    damaged[PrtSections(good).all[1].begin + 70] ^= 1;
    refuse(damaged, "is damaged: the chunk of visibility from row 0");
    write_bytes(path_, good);
    expect_failure({"export", path_, "-o", out, "--kind", "bent_normal"}, 2,
                   path_ + ": does not hold bent_normal");
    expect_failure({"export", directory_ / "b.prt", "-o", out}, 1, "b.prt: does not exist");
    write_bytes(out, "");
    expect_failure({"export", path_, "-o", out}, 1, "already exists (use --force to replace it)");
}

}  // namespace
}  // namespace airlight
