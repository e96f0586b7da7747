// SPDX-License-Identifier: Apache-2.0
#include "core/json_fields.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"

namespace airlight {
namespace {

const std::string kText = R"({
  "name": "lamp", "on": true,
  "size": [1,
    2.5,
    -3
  ],
  "count": 7
  ,
  "lights": [
    {"power": 1},
    {"power":
      2},
    5
  ]
})";

std::string complaint(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::data);
        return error.describe();
    }
    return "nothing";
}

TEST(JsonTree, KnowsTheLineOfEveryValue) {
    const JsonValue root = parse_json(kText, "a.json", 3);
    EXPECT_EQ(root.line(), 1);
    EXPECT_EQ(root.find("on")->line(), 2);
    const JsonValue& size = *root.find("size");
    EXPECT_EQ(size.line(), 3);
    EXPECT_EQ(size.items()[0].line(), 3);
    EXPECT_EQ(size.items()[1].line(), 4);
    // The parser has to see the line break to know that the number ends.
    EXPECT_EQ(size.items()[2].line(), 5);
    EXPECT_EQ(root.find("count")->line(), 7);
    const JsonValue& lights = *root.find("lights");
    EXPECT_EQ(lights.items()[1].line(), 11);
    EXPECT_EQ(lights.items()[1].find("power")->line(), 12);
    EXPECT_EQ(lights.items()[2].line(), 13);
    EXPECT_EQ(root.find("none"), nullptr);
}

TEST(JsonTree, HoldsValuesAsTheyAreWritten) {
    const JsonValue root = parse_json(
        R"(["\u00e9", 1e3, 2.0, 2, -0.0, 18446744073709551615, null, false, {}])", "a.json", 1);
    const auto& items = root.items();
    EXPECT_EQ(items[0].text(), "\u00e9");
    EXPECT_EQ(items[1].number(), 1000);
    EXPECT_FALSE(items[1].is_integer());
    EXPECT_EQ(items[2].quote(), "2.0");
    EXPECT_EQ(items[3].quote(), "2");
    EXPECT_TRUE(std::signbit(items[4].number()));
    EXPECT_EQ(items[5].quote(), "18446744073709551615");
    EXPECT_EQ(items[5].number(), 18446744073709551616.0);
    EXPECT_EQ(items[6].quote(), "null");
    EXPECT_EQ(items[7].quote(), "false");
    EXPECT_EQ(items[8].quote(), "an object");
    EXPECT_EQ(parse_json("\"" + std::string(100, 'x') + "\"", "a", 0).quote(),
              "\"" + std::string(39, 'x') + "...");
}

TEST(JsonTree, RefusesWhatIsNoJsonByLine) {
    const auto parse = [](const std::string& text) {
        return complaint([&] { parse_json(text, "a.json", 3); });
    };
    EXPECT_EQ(parse(""), "a.json: is empty");
    EXPECT_EQ(parse("\n\n"), "a.json: is no whole JSON: it ends too early");
    EXPECT_EQ(parse(kText.substr(0, kText.size() - 1)),
              "a.json: is no whole JSON: it ends too early");
    EXPECT_EQ(parse("{\n\"a\": 1\n\"b\": 2}"), "a.json:3: is no JSON: this line cannot be read");
    EXPECT_EQ(parse("[1]\n]"), "a.json:2: is no JSON: this line cannot be read");
    EXPECT_EQ(parse("[\n1e999]"), "a.json:2: 1e999 is beyond 1.8e308, the largest number");
    EXPECT_EQ(parse("{\n\"a\": 1,\n\"a\": 1}"), "a.json:3: the field a is given twice");
    EXPECT_EQ(parse("[\n[\n[\n[0]]]]"), "a.json:4: is nested more than 3 deep");
    EXPECT_EQ(parse(std::string(1000000, '[')), "a.json:1: is nested more than 3 deep");
}

TEST(JsonFields, NameFieldLineValueAndLimit) {
    const JsonValue root = parse_json(kText, "a.json", 3);
    const JsonFields fields(root, "", "a.json");
    EXPECT_EQ(fields.text("name"), "lamp");
    EXPECT_TRUE(fields.boolean("on"));
    EXPECT_EQ(fields.integer("count", 0, 7), 7);
    EXPECT_EQ(fields.numbers("size", 3), (std::vector<double>{1, 2.5, -3}));
    EXPECT_EQ(fields.choice("name", {"sun", "lamp"}), 1);
    EXPECT_EQ(complaint([&] { fields.integer("count", 0, 6); }),
              "a.json:7: count is 7, not an integer in [0, 6]");
    EXPECT_EQ(complaint([&] { fields.number("count", 8); }),
              "a.json:7: count is 7, not a number >= 8");
    EXPECT_EQ(complaint([&] { fields.numbers("size", 3, 0, 9); }),
              "a.json:5: size[2] is -3, not a number in [0, 9]");
    EXPECT_EQ(complaint([&] { fields.numbers("size", 2); }),
              "a.json:3: size is an array of 3 values, not an array of 2 numbers");
    EXPECT_EQ(complaint([&] {
                  fields.choice("name", {"sun", "moon", "star"});
              }),
              "a.json:2: name is \"lamp\", not sun, moon or star");
    EXPECT_EQ(complaint([&] { fields.text("none"); }), "a.json:1: the field none is missing");
    EXPECT_EQ(complaint([&] { fields.object("size"); }),
              "a.json:3: size is an array of 3 values, not an object");
    EXPECT_EQ(complaint([&] { fields.objects("lights"); }),
              "a.json:13: lights[2] is 5, not an object");
    EXPECT_EQ(complaint([&] { fields.refuse("size[1]", "is odd"); }), "a.json:3: size[1] is odd");
    const JsonFields lamp(root.find("lights")->items()[1], "lights[1]", "a.json");
    EXPECT_EQ(complaint([&] { lamp.number("power", 3, 4); }),
              "a.json:12: lights[1].power is 2, not a number in [3, 4]");
}

TEST(JsonFields, UnknownOnesAreRefusedWithTheNearestThatIsKnown) {
    const JsonValue root = parse_json(kText, "a.json", 3);
    const JsonFields fields(root, "", "a.json");
    fields.know({"name", "on", "size", "count", "lights"});
    EXPECT_EQ(complaint([&] {
                  fields.know({"name", "on", "size", "counts", "lights"});
              }),
              "a.json:7: the field count is unknown; is counts meant?");
    // What is there already is not meant, nor is a word of other letters.
    EXPECT_EQ(complaint([&] {
                  fields.know({"name", "on", "size", "lights"});
              }),
              "a.json:7: the field count is unknown");
}

TEST(JsonTree, TakesNoMoreMemoryThanItSays) {
    for (const std::string piece : {"0,", "[],", "{},", "\"\",", "{\"a\":0},", "[0],", "12.5,"}) {
        std::string text = "[";
        while (text.size() < 300000) text += piece;
        text.back() = ']';
        const std::size_t before = mallinfo2().uordblks;
        const JsonValue root = parse_json(text, "a.json", 3);
        // The tree, and half as much again while its longest vector grew.
        EXPECT_LE(1.5 * double(mallinfo2().uordblks - before), double(kJsonTreeBytes * text.size()))
            << piece;
    }
}

}  // namespace
}  // namespace airlight
