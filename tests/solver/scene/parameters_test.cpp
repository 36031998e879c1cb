// Every key of the table, with good and bad values made from its declaration.
#include "solver/scene/parameters.hpp"
#include "tests/solver/scene/scene_folder.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace slurry::test {
namespace {

using Words = std::vector<std::string>;

// A number inside the interval, away from its ends.
double inside(const Allowed& allowed) {
    if (std::isfinite(allowed.lower) && std::isfinite(allowed.upper)) {
        return std::min(allowed.lower + 0.25, (allowed.lower + allowed.upper) / 2);
    }
    return std::isfinite(allowed.lower) ? allowed.lower + 0.25 : 0.5;
}

std::string whole_inside(const Allowed& allowed) {
    return fmt::format("{:.0f}", allowed.lower + 1);
}

Words choices(const Allowed& allowed) {
    Words words;
    for (const std::string_view choice : allowed.choices) {
        words.push_back(fmt::format("\"{}\"", choice));
    }
    return words;
}

// Values of which at least one must be accepted: the rest may contradict another key of the scene.
Words good_values(const Parameter& parameter) {
    const Allowed& allowed = parameter.allowed;
    switch (parameter.binding.kind) {
    case Kind::boolean:
        return {"true", "false"};
    case Kind::integer:
        return {whole_inside(allowed)};
    case Kind::number:
        return {fmt::format("{}", inside(allowed))};
    case Kind::text:
        return {"\"some-name\"", "\"cosine\""};
    case Kind::file:
        return {parameter.section == "walls" ? "\"profile.csv\"" : "\"radii.csv\""};
    case Kind::choice:
        return choices(allowed);
    case Kind::vector:
        return {fmt::format("[{}, {}]", inside(allowed), inside(allowed) + 0.25)};
    case Kind::counts:
        return {fmt::format("[{0}, {0}]", whole_inside(allowed))};
    case Kind::numbers:
        return {"[]", fmt::format("[{}]", inside(allowed))};
    }
    return {};
}

// Numbers out of the interval, if there are any.
Words outside(const Allowed& allowed) {
    Words words;
    if (std::isfinite(allowed.lower)) {
        words.push_back(fmt::format("{}", allowed.lower_excluded ? allowed.lower : allowed.lower - 1));
    }
    if (std::isfinite(allowed.upper)) {
        words.push_back(fmt::format("{:.0f}", allowed.upper + 1));
    }
    return words;
}

Words bad_numbers(const Parameter& parameter) {
    Words words = outside(parameter.allowed);
    words.insert(words.end(), {"nan", "inf", "-inf", "true", "word", "1979-05-27", "[[1, 2], [3, 4]]"});
    return words;
}

Words bad_values(const Parameter& parameter) {
    Words words{"{}", "[true]", "07:32:00"};
    const Kind kind = parameter.binding.kind;
    const bool listed = kind == Kind::vector || kind == Kind::counts || kind == Kind::numbers;
    if (kind == Kind::boolean) {
        words.insert(words.end(), {"1", "0.0", "yes", "\"true\""});
    } else if (kind == Kind::text || kind == Kind::file || kind == Kind::choice) {
        words.insert(words.end(), {"1", "true", "[\"a\"]", R"("a\nb")", R"("\u007f")", R"("\u0000")"});
        words.push_back(fmt::format("\"{:x>1001}\"", "x"));
    } else {
        for (const std::string& word : bad_numbers(parameter)) {
            words.push_back(listed ? fmt::format("[{0}, {0}]", word) : word);
        }
    }
    if (kind == Kind::integer || kind == Kind::counts) {
        words.insert(words.end(), {"1.5", "[1.5, 2]", "99999999999999999999"});
    }
    if (kind == Kind::vector || kind == Kind::counts) {
        words.insert(words.end(), {"1", "[]", "[1]", "[1, 2, 3]"});
    }
    if (kind == Kind::choice) {
        words.insert(words.end(), {"\"\"", "\"no_such_choice\""});
    }
    if (parameter.allowed.identifier) {
        words.insert(words.end(), {"\"\"", "\"a b\"", "\"a.b\"", "\"a/b\"", "\"\u00e9\""});
    }
    if (kind == Kind::file) {
        words.insert(words.end(),
                     {"\"\"", "\"no_such.csv\"", "\"../profile.csv\"", "\"a/../../profile.csv\"", "\".\""});
    }
    return words;
}

// The name of a table of full_scene that has the key, and its index.
std::pair<std::string, std::size_t> table_of(const Parameter& parameter) {
    const Section* section = find_section(parameter.section);
    if (!section->repeated()) {
        return {std::string(section->name), 0};
    }
    const auto& variants = find_parameter(section->name, section->selector)->allowed.choices;
    const auto found =
        std::ranges::find(variants, parameter.variant.empty() ? variants.front() : parameter.variant);
    return {fmt::format("{}.{}", section->name, *found), static_cast<std::size_t>(found - variants.begin())};
}

// What else has to change in full_scene for the key to have a meaning.
Words companions(const Parameter& parameter) {
    const std::string address = parameter.address();
    if (address == "discs.area_fraction" || address == "discs.weight_fraction") {
        return {"discs.random.count=0"};
    }
    if (address == "discs.spread") {
        return {"discs.random.sizes=uniform"};
    }
    if (address == "discs.file") {
        return {"discs.random.sizes=file", "discs.random.radius=0"};
    }
    return {};
}

std::string toml_of(const Parameter& parameter, const Scene& scene, std::size_t index) {
    Value value = parameter.get(scene, index);
    if (parameter.binding.kind == Kind::file) {
        value = std::filesystem::path(std::get<std::string>(value)).filename().string();
    }
    return to_toml(value, parameter.binding.kind);
}

std::string without(const std::string& text, char unwanted) {
    std::string result = text;
    std::erase(result, unwanted);
    return result;
}

class EveryKey : public SceneFolder, public ::testing::WithParamInterface<Parameter> {};

TEST_P(EveryKey, TakesAGoodValue) {
    const auto [table, index] = table_of(GetParam());
    int accepted = 0;
    std::string last;
    for (const std::string& value : good_values(GetParam())) {
        const std::string change = fmt::format("{}.{}={}", table, GetParam().key, value);
        Words changes = companions(GetParam());
        changes.push_back(change);
        last = refusal(full_scene, changes);
        if (last.starts_with("ACCEPTED")) {
            ++accepted;
            const Scene scene = read(full_scene, changes);
            const std::string expected =
                GetParam().binding.kind == Kind::number && value.find('.') == std::string::npos ? value + ".0"
                                                                                                : value;
            EXPECT_EQ(without(toml_of(GetParam(), scene, index), ' '), without(expected, ' ')) << change;
        }
    }
    EXPECT_GE(accepted, 1) << last;
}

TEST_P(EveryKey, RefusesBadValues) {
    const auto [table, index] = table_of(GetParam());
    for (const std::string& value : bad_values(GetParam())) {
        const std::string change = fmt::format("{}.{}={}", table, GetParam().key, value);
        Words changes = companions(GetParam());
        changes.push_back(change);
        const std::string message = refusal(full_scene, changes);
        EXPECT_TRUE(message.starts_with("--set " + change.substr(0, 30))) << change << "\n" << message;
        EXPECT_NE(message.find(": found "), std::string::npos) << message;
        EXPECT_NE(message.find(", allowed "), std::string::npos) << message;
    }
}

// Every line of the resolved text is one key: take one away, or misspell it.
class EveryLine : public SceneFolder {
  protected:
    struct Line {
        std::string key; // empty for headers and blank lines
        std::string section;
        std::size_t number;
    };

    EveryLine() : resolved_(read(full_scene).resolved_text) {
        std::istringstream stream(resolved_);
        std::string section;
        for (std::string line; std::getline(stream, line);) {
            texts_.push_back(line);
            const std::string key = line.substr(0, line.find(" = "));
            if (line.starts_with('[')) {
                section = without(without(line, '['), ']');
            } else if (!line.empty()) {
                lines_.push_back({key, section, texts_.size()});
            }
        }
    }

    // The resolved text with one line replaced.
    [[nodiscard]] std::string with(const Line& line, const std::string& text) const {
        std::string result;
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            result += (i + 1 == line.number ? text : texts_[i]) + "\n";
        }
        return result;
    }
    [[nodiscard]] const std::string& text(const Line& line) const { return texts_[line.number - 1]; }

    std::string resolved_;
    Words texts_;
    std::vector<Line> lines_;
};

TEST_F(EveryLine, OfTheTableIsInTheResolvedText) {
    for (const Parameter& parameter : parameters()) {
        EXPECT_TRUE(std::ranges::any_of(lines_, [&](const Line& line) {
            return line.section == parameter.section && line.key == parameter.key;
        })) << parameter.address();
    }
}

TEST_F(EveryLine, LeftOutIsRefusedOrTakesTheDefault) {
    for (const Line& line : lines_) {
        const std::string message = refusal(with(line, ""));
        const bool is_required = message.find(": found no " + line.section + ".") != std::string::npos;
        // Velocity and speed go together; a random group needs a count and radii, or other keys in their
        // stead.
        const bool depends = line.section == "start" || (line.section == "discs" && line.key == "count") ||
                             (line.section == "discs" && line.key == "radius");
        EXPECT_TRUE(is_required || depends || message.starts_with("ACCEPTED")) << text(line) << "\n"
                                                                               << message;
        const auto declared = [&](const Parameter& parameter) {
            return parameter.section == line.section && parameter.key == line.key &&
                   is_required != parameter.fallback.standard.has_value();
        };
        EXPECT_TRUE(depends || std::ranges::any_of(parameters(), declared)) << text(line) << "\n" << message;
    }
}

TEST_F(EveryLine, MisspelledIsRefusedWithThePlaceAndTheNearestKey) {
    for (const Line& line : lines_) {
        const std::string wrong = line.key.substr(0, 1) + "_" + line.key.substr(1);
        const std::string message = refusal(with(line, replaced(text(line), line.key, wrong)));
        EXPECT_TRUE(message.starts_with(fmt::format("scene.toml:{}:1: found the unknown key {} in [{}]",
                                                    line.number, wrong, line.section)))
            << message;
        EXPECT_TRUE(message.ends_with(fmt::format("nearest known key {}.{}", line.section, line.key)))
            << message;
    }
}

TEST(Parameters, AreDeclaredInFull) {
    for (const Parameter& parameter : parameters()) {
        EXPECT_FALSE(parameter.meaning.empty()) << parameter.address();
        EXPECT_EQ(parameter.binding.kind == Kind::choice, !parameter.allowed.choices.empty())
            << parameter.address();
        EXPECT_NE(find_section(parameter.section), nullptr) << parameter.address();
    }
}

TEST(Parameters, HaveTheDefaultsOfTheScene) {
    for (const Parameter& parameter : parameters()) {
        const std::optional<Value>& fallback = parameter.fallback.standard;
        if (find_section(parameter.section)->repeated() || fallback != parameter.fallback.wang2014 ||
            !fallback) {
            continue; // needs a wall or probe, depends on the scheme, or is required
        }
        EXPECT_EQ(parameter.get(Scene{}, 0), *fallback) << parameter.address();
    }
}

std::string test_name(const ::testing::TestParamInfo<Parameter>& info) {
    return fmt::format("{}_{}{}{}", info.param.section, info.param.variant,
                       info.param.variant.empty() ? "" : "_", info.param.key);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryKey, ::testing::ValuesIn(parameters()), test_name);

} // namespace

// Keeps GoogleTest from printing the bytes of a parameter.
void PrintTo(const Parameter& parameter, std::ostream* stream) {
    *stream << parameter.address();
}

} // namespace slurry::test
