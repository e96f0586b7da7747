// SPDX-License-Identifier: Apache-2.0
// Damage to the bytes of a file, the same for the same generator.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <random>
#include <string>

namespace airlight {

/// One to eight changes: other bytes, flipped bits, pieces taken out, repeated, or the end cut off.
inline std::string mutate(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
    const std::size_t changes = 1 + below(8);
    for (std::size_t change = 0; change < changes && !bytes.empty(); ++change) {
        // Half of the damage goes to the header, where it does most.
        const std::size_t at =
            below(random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 400) : bytes.size());
        switch (below(6)) {
            case 0:
                bytes[at] = static_cast<char>(random());
                break;
            case 1:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes[at] = static_cast<char>(below(2) == 0 ? 0xff : 0x7f);
                break;
            case 3:
                bytes.erase(at, 1 + below(8));
                break;
            case 4:
                bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(16)));
                break;
            default:
                bytes.resize(at);
                break;
        }
    }
    return bytes;
}

/// One to three changes to a JSON text: other bytes, digits, pieces of its grammar, pieces taken
/// out or repeated.
inline std::string mutate_json(std::string text, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
    constexpr const char* kPieces[] = {"[", "]", "{",     "}",   "\"",   ",",
                                       ":", "-", "1e999", "NaN", "null", "\xff"};
    for (std::size_t change = 1 + below(3); change > 0 && !text.empty(); --change) {
        const std::size_t at = below(text.size());
        switch (below(5)) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, 1 + below(8));
                break;
            case 2:
                text.insert(at, kPieces[below(std::size(kPieces))]);
                break;
            case 3:
                text.insert(at, text.substr(below(text.size()), 1 + below(60)));
                break;
            default:
                text[at] = static_cast<char>('0' + below(10));
                break;
        }
    }
    return text;
}

}  // namespace airlight
