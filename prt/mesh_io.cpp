// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_io.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/open_input.h"
#include "prt/mesh_text.h"
#include "prt/raw_mesh.h"

namespace airlight {
namespace {

using detail::MemoryBudget;
using detail::RawMesh;
using detail::Source;

constexpr std::size_t kBlock = std::size_t{1} << 20;
// Enough to tell a format by.
constexpr std::size_t kStart = 1024;

enum class MeshFormat { none, obj, ply, stl_text, stl_binary, off };

bool has_extension(const std::string& name, std::string_view extension) {
    return name.size() > extension.size() &&
           detail::lower_case(std::string_view(name).substr(name.size() - extension.size())) ==
               extension;
}

bool is_obj_word(std::string_view word) {
    constexpr std::array<std::string_view, 13> kWords = {
        "v", "vn", "vt", "vp", "f", "l", "p", "o", "g", "s", "usemtl", "mtllib", "cstype"};
    return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

bool is_off_word(std::string_view word) {
    const std::size_t at = word.find("OFF");
    return at != std::string_view::npos && at + 3 == word.size() &&
           word.find_first_not_of("STCN4n") >= at;
}

/// `start` is the begin of a file of `size` bytes, whose name may decide.
MeshFormat recognise(std::string_view start, std::size_t size, const std::string& name) {
    if (start.substr(0, 4) == "ply\n" || start.substr(0, 4) == "ply\r") return MeshFormat::ply;
    if (start.size() >= detail::kStlHeader &&
        size == detail::kStlHeader + detail::kStlRecord * detail::stl_claim(start)) {
        return MeshFormat::stl_binary;
    }
    detail::TextLines lines(start.substr(0, kStart), '#', false);
    std::string_view first, second;
    if (lines.next_filled()) first = lines.word();
    if (lines.next_filled()) second = lines.word();
    if (is_off_word(first)) return MeshFormat::off;
    if (detail::lower_case(first) == "solid") {
        // Binary files may begin with the word too.
        const std::string next = detail::lower_case(second);
        if (second.empty() || next == "facet" || next == "endsolid" ||
            !has_extension(name, ".stl")) {
            return MeshFormat::stl_text;
        }
    }
    if (has_extension(name, ".stl")) return MeshFormat::stl_binary;
    if (has_extension(name, ".obj") || is_obj_word(first)) return MeshFormat::obj;
    return MeshFormat::none;
}

RawMesh parse_raw(Source source) {
    if (source.bytes.empty()) source.refuse("is empty");
    source.report.file_bytes = source.bytes.size();
    // A byte order mark would stick to the first word.
    if (source.bytes.substr(0, 3) == "\xEF\xBB\xBF") source.bytes.remove_prefix(3);
    switch (recognise(source.bytes.substr(0, kStart), source.bytes.size(), source.name)) {
        case MeshFormat::obj:
            return parse_obj(source);
        case MeshFormat::ply:
            return parse_ply(source);
        case MeshFormat::stl_text:
            return parse_stl_text(source);
        case MeshFormat::stl_binary:
            return parse_stl_binary(source);
        case MeshFormat::off:
            return parse_off(source);
        case MeshFormat::none:
            break;
    }
    source.refuse("is no OBJ, PLY, STL or OFF mesh");
}

// Read, not mapped: a file that shrinks meanwhile would end the process.
std::string load(const OpenInput& file, MemoryBudget& budget) {
    std::string bytes;
    if (file.has_size) {
        budget.take(file.size, 1, "the file");
        bytes.resize(file.size);
        bytes.resize(read_at(file.descriptor.get(), bytes.data(), bytes.size(), 0, file.name));
        return bytes;
    }
    for (;;) {
        const std::size_t before = bytes.size();
        if (before + kBlock > bytes.capacity()) {
            const std::size_t capacity = std::max(2 * bytes.capacity(), 4 * kBlock);
            budget.take(capacity, 1, "the input");
            budget.give_back(bytes.capacity());
            bytes.reserve(capacity);
        }
        bytes.resize(before + kBlock);
        const ssize_t got = ::read(file.descriptor.get(), bytes.data() + before, kBlock);
        if (got < 0 && errno != EINTR) {
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), file.name);
        }
        bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        if (got == 0) return bytes;
    }
}

}  // namespace

Mesh parse_mesh(std::string_view bytes, const std::string& name, const MeshReadOptions& options,
                MeshReport* report) {
    MeshReport figures;
    MemoryBudget budget(options.max_memory, name);
    budget.take(bytes.size(), 1, "the file");
    const Source source = {name, bytes, budget, figures};
    Mesh mesh = detail::build_mesh(parse_raw(source), options, name, budget, figures);
    if (report != nullptr) *report = std::move(figures);
    return mesh;
}

Mesh read_mesh(const std::string& path, const MeshReadOptions& options, MeshReport* report) {
    const OpenInput input = open_input(path, "a mesh");
    MeshReport figures;
    MemoryBudget budget(options.max_memory, input.name);
    RawMesh raw;
    {
        const std::string bytes = load(input, budget);
        raw = parse_raw({input.name, bytes, budget, figures});
        budget.give_back(bytes.capacity());
    }
    Mesh mesh = detail::build_mesh(std::move(raw), options, input.name, budget, figures);
    if (report != nullptr) *report = std::move(figures);
    return mesh;
}

bool looks_like_mesh(const std::string& path) {
    for (const char* extension : {".obj", ".ply", ".stl", ".off"}) {
        if (has_extension(path, extension)) return true;
    }
    try {
        const OpenInput file = open_input(path, "a mesh");
        if (!file.has_size) return false;
        std::string start(std::min(file.size, kStart), '\0');
        start.resize(read_at(file.descriptor.get(), start.data(), start.size(), 0, path));
        return recognise(start, file.size, path) != MeshFormat::none;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace airlight
