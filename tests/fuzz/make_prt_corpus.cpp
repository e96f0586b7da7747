// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of corpus/prt. Usage: make_prt_corpus DIRECTORY
#include <cstdio>
#include <exception>

#include "tests/prt/prt_bytes.h"

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_prt_corpus DIRECTORY\n");
        return 2;
    }
    try {
        const std::string directory = std::string(arguments[1]) + "/";
        airlight::PrtHeader header = airlight::some_header();
        airlight::write_prt(directory + "several.prt", header);
        airlight::write_prt(directory + "empty.prt", airlight::some_header(0));
        header.shards = 7;
        header.shard = 3;
        header.mesh_vertices = 100;
        header.first_row = 40;
        header.order = 1;
        header.tables = {{airlight::PrtKind::vertex_index, airlight::PrtType::uint32},
                         {airlight::PrtKind::bent_normal, airlight::PrtType::float16},
                         {airlight::PrtKind::visibility_error, airlight::PrtType::float32},
                         {airlight::PrtKind::transfer_error, airlight::PrtType::float16}};
        airlight::write_prt(directory + "part.prt", header, "{\"a\": [1, {\"b\": null}]}");
        header = airlight::some_header(3);
        header.order = 4;
        header.tables = {{airlight::PrtKind::transfer, airlight::PrtType::float32}};
        header.block_rows = 1;
        airlight::write_prt(directory + "rows.prt", header, "{}");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_prt_corpus: %s\n", error.what());
        return 1;
    }
    return 0;
}
