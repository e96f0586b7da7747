// SPDX-License-Identifier: Apache-2.0
// docs/scene.schema.json and the reader take the same scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/core/scratch_directory.h"
#include "tests/viewer/full_scene.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

using Json = nlohmann::json;

/// As much of JSON Schema as the schema of scenes uses; a word that it does not know fails.
class Schema {
  public:
    explicit Schema(Json root) : root_(std::move(root)) {}

    bool takes(const Json& value) const { return takes(root_, value); }

  private:
    static bool has_type(const std::string& type, const Json& value) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "number") return value.is_number();
        if (type == "integer") {
            return value.is_number() && value.get<double>() == std::floor(value.get<double>());
        }
        ADD_FAILURE() << "type " << type;
        return false;
    }

    std::size_t count_taken(const Json& schemas, const Json& value) const {
        std::size_t taken = 0;
        for (const Json& schema : schemas) taken += takes(schema, value) ? 1 : 0;
        return taken;
    }

    bool takes(const Json& schema, const Json& value) const {
        for (const auto& [word, rule] : schema.items()) {
            if (!obeys(schema, word, rule, value)) return false;
        }
        return true;
    }

    bool obeys(const Json& schema, const std::string& word, const Json& rule,
               const Json& value) const {
        const double number = value.is_number() ? value.get<double>() : 0;
        if (word == "$ref") {
            return takes(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value);
        }
        if (word == "type") return has_type(rule, value);
        if (word == "const") return value == rule;
        if (word == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
        if (word == "oneOf") return count_taken(rule, value) == 1;
        if (word == "anyOf") return count_taken(rule, value) > 0;
        if (word == "not") return !takes(rule, value);
        if (word == "minimum") return !value.is_number() || number >= rule;
        if (word == "maximum") return !value.is_number() || number <= rule;
        if (word == "exclusiveMinimum") return !value.is_number() || number > rule;
        if (word == "exclusiveMaximum") return !value.is_number() || number < rule;
        if (word == "minLength") return !value.is_string() || !value.get<std::string>().empty();
        if (word == "minItems") return !value.is_array() || value.size() >= rule;
        if (word == "maxItems") return !value.is_array() || value.size() <= rule;
        if (word == "items") {
            return !value.is_array() || std::all_of(value.begin(), value.end(),
                                                    [&](const Json& v) { return takes(rule, v); });
        }
        if (word == "required") {
            return !value.is_object() || std::all_of(rule.begin(), rule.end(), [&](const Json& k) {
                return value.contains(k.get<std::string>());
            });
        }
        if (word == "properties") {
            if (!value.is_object()) return true;
            for (const auto& [key, inner] : rule.items()) {
                if (value.contains(key) && !takes(inner, value[key])) return false;
            }
            return true;
        }
        if (word == "additionalProperties") {
            if (!value.is_object()) return true;
            for (const auto& item : value.items()) {
                if (!schema["properties"].contains(item.key())) return false;
            }
            return true;
        }
        const bool says_nothing = word == "$schema" || word == "$defs" || word == "title" ||
                                  word == "description" || word == "default";
        EXPECT_TRUE(says_nothing) << word;
        return says_nothing;
    }

    Json root_;
};

/// Every scene that differs from `scene` in one place.
std::vector<Json> neighbours_of(const Json& scene) {
    const std::vector<Json> others = {
        nullptr, true,          "text",         0,      -1,       0.5, 1e3, -1e31, 1e31,
        1e-13,   Json::array(), Json::object(), {1, 2}, {1, 2, 3}};
    std::vector<Json> all;
    const Json flat = scene.flatten();
    std::vector<std::string> places;
    for (const auto& item : flat.items()) {
        for (std::string place = item.key(); !place.empty(); place.erase(place.rfind('/'))) {
            if (std::find(places.begin(), places.end(), place) == places.end()) {
                places.push_back(place);
            }
        }
    }
    for (const std::string& place : places) {
        const Json::json_pointer at(place), parent = at.parent_pointer();
        for (const Json& other : others) {
            all.push_back(scene);
            all.back()[at] = other;
        }
        all.push_back(scene);
        if (scene.at(parent).is_object()) {
            all.back().at(parent).erase(at.back());
            all.push_back(scene);
            Json& moved = all.back().at(parent);
            moved["other"] = moved[at.back()];
            moved.erase(at.back());
        } else {
            all.back().at(parent).erase(static_cast<std::size_t>(std::stoi(at.back())));
            all.push_back(scene);
            all.back().at(parent).push_back(scene.at(at));
        }
    }
    return all;
}

/// What no schema can say: other numbers of the scene, or the disk, decide.
bool is_beyond_schemas(const std::string& complaint) {
    for (const char* words : {"is the position of the camera", "across the view", "not more than",
                              "is singular", "is not affine", "no such file", "blobs.ply"}) {
        if (complaint.find(words) != std::string::npos) return true;
    }
    return false;
}

TEST(SceneSchema, TakesWhatTheReaderTakes) {
    std::ifstream file(AIRLIGHT_SCENE_SCHEMA);
    const Schema schema(Json::parse(file));
    const ScratchDirectory directory;
    make_full_scene_files(directory);
    const Json scene = Json::parse(kFullScene);
    ASSERT_TRUE(schema.takes(scene));
    int taken = 0, refused = 0;
    for (const Json& neighbour : neighbours_of(scene)) {
        std::string complaint;
        try {
            parse_scene(neighbour.dump(), directory / "scene.json");
        } catch (const Error& error) {
            complaint = error.describe();
        }
        if (is_beyond_schemas(complaint)) continue;
        EXPECT_EQ(schema.takes(neighbour), complaint.empty())
            << complaint << "\n"
            << Json::diff(scene, neighbour).dump();
        ++(complaint.empty() ? taken : refused);
    }
    EXPECT_GT(taken, 300);
    EXPECT_GT(refused, 2000);
}

TEST(SceneSchema, TakesTheExamples) {
    std::ifstream file(AIRLIGHT_SCENE_SCHEMA);
    const Schema schema(Json::parse(file));
    int examples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_SCENES)) {
        if (entry.path().extension() != ".json") continue;
        const std::string path = entry.path().string();
        std::ifstream scene(path);
        EXPECT_TRUE(schema.takes(Json::parse(scene))) << path;
        EXPECT_NO_THROW(read_scene(path)) << path;
        ++examples;
    }
    EXPECT_GE(examples, 15);
}

}  // namespace
}  // namespace airlight
