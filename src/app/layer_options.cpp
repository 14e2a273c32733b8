#include "app/layer_options.h"

#include <algorithm>
#include <cmath>

#include "app/options.h"

namespace relief::app {
namespace {

constexpr double kMostRepeats = 1024;

double parseNumber(const std::string& word, const std::string& key, const std::string& value) {
    double number = 0;
    if (value.empty() || !CLI::detail::lexical_cast(value, number) || !(std::abs(number) <= 1e12))
        fail(Failure::usage, "--layer {}: {}={} is not a number", word, key, value);
    return number;
}

/// "4:2", or "4" for both.
dvec2 parsePair(const std::string& word, const std::string& key, const std::string& value) {
    const std::size_t colon = value.find(':');
    const double first = parseNumber(word, key, value.substr(0, colon));
    return {first, colon == std::string::npos ? first : parseNumber(word, key, value.substr(colon + 1))};
}

bool isRepeat(double number) { return number != 0 && std::abs(number) <= kMostRepeats; }

template <typename Value, std::size_t kCount>
Value parseWord(const std::string& word, const std::string& key, const std::string& value,
                const Word<Value> (&table)[kCount]) {
    std::string known;
    for (const Word<Value>& row : table) {
        if (row.word == value) return row.value;
        known += (known.empty() ? "" : ", ") + std::string(row.word);
    }
    fail(Failure::usage, "--layer {}: {}={} is not one of {}", word, key, value, known);
}

/// Keys of vector maps that are read after the space and the preset, which say what they start from.
struct VectorKeys {
    std::optional<VectorSpace> space;
    std::optional<VectorPreset> preset;
    std::optional<std::string> order, flip;
};

void takeVectors(LayerDesc& layer, const VectorKeys& keys, const std::string& word) {
    if (!keys.space) {
        if (keys.preset || keys.order || keys.flip)
            fail(Failure::usage, "--layer {}: preset, order and flip are of vectors; add vector=tangent or object",
                 word);
        return;
    }
    layer.vectors.emplace().space = *keys.space;
    if (keys.preset) applyPreset(*layer.vectors, *keys.preset);
    if (keys.order) layer.vectors->order = *keys.order;
    if (keys.flip) layer.vectors->flip = *keys.flip;
}

constexpr const char* kKeys[] = {"scale",  "mid",    "channel", "mask",  "repeat",
                                 "offset", "vector", "preset",  "order", "flip"};

} // namespace

LayerDesc parseLayer(const std::string& word) {
    LayerDesc layer;
    VectorKeys vectors;
    std::vector<std::string> seen;
    for (const std::string& part : CLI::detail::split(word, ',')) {
        const std::size_t equals = part.find('=');
        const std::string key = part.substr(0, equals);
        // Parts without an equals sign before the first key belong to the name of the file.
        if (layer.path.empty() || (seen.empty() && equals == std::string::npos)) { // names of files may hold commas
            layer.path += (layer.path.empty() ? "" : ",") + part;
            continue;
        }
        const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
        if (std::ranges::find(seen, key) != seen.end())
            fail(Failure::usage, "--layer {}: {}= is given twice", word, key);
        seen.push_back(key);
        if (key == "scale")
            layer.scale = parseNumber(word, key, value);
        else if (key == "mid")
            layer.mid = parseNumber(word, key, value);
        else if (key == "channel")
            layer.channel = value;
        else if (key == "mask")
            layer.mask = value;
        else if (key == "repeat")
            layer.placement.repeat = parsePair(word, key, value);
        else if (key == "offset")
            layer.placement.offset = parsePair(word, key, value);
        else if (key == "vector")
            vectors.space = parseWord(word, key, value, kVectorSpaces);
        else if (key == "preset")
            vectors.preset = parseWord(word, key, value, kVectorPresets);
        else if (key == "order")
            vectors.order = value;
        else if (key == "flip")
            vectors.flip = value;
        else
            fail(Failure::usage, "--layer {}: {} is not one of {}", word, key, fmt::join(kKeys, ", "));
    }
    if (layer.path.empty()) fail(Failure::usage, "--layer {}: it begins with the name of a map", word);
    if (!isRepeat(layer.placement.repeat.x) || !isRepeat(layer.placement.repeat.y))
        fail(Failure::usage, "--layer {}: repeat= is a number from -{} to {}, other than 0", word, kMostRepeats,
             kMostRepeats);
    // A preset first, then what the word says besides: so the order of keys does not matter.
    takeVectors(layer, vectors, word);
    return layer;
}

void addLayers(CLI::App& app, HeightDesc& height) {
    const auto set = [&height](const std::vector<std::string>& words) {
        height.layers.clear();
        for (const std::string& word : words) height.layers.push_back(parseLayer(word));
    };
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        "--layer", set,
        "one more map, added to --height or --vector, as often as it is given: its file, then scale=, mid=, channel=, "
        "mask=MAP (what it is multiplied with, 0 to 1), repeat=U:V, offset=U:V, and of vectors vector=tangent or "
        "object, preset=, order=, flip=");
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    option->allow_extra_args(false); // else a cage that follows would be taken for one more layer
    listIn("height", "MAP[,KEY=VALUE...]", option);
}

void addPlacement(CLI::App& app, ObjectDesc& object) {
    const CLI::Validator repeats(
        [](const std::string& word) {
            double number = 0;
            return CLI::detail::lexical_cast(word, number) && isRepeat(number)
                       ? std::string()
                       : fmt::format("{} is not a number from -{} to {} other than 0", word, kMostRepeats,
                                     kMostRepeats);
        },
        "");
    listIn(
        "maps", "U,V",
        addVector<dvec2>(app, "--map-repeat", object.placement.repeat,
                         "how often all maps repeat over the unit square: texture coordinates are multiplied with it "
                         "(default: 1,1)")
            ->check(repeats));
    listIn("maps", "U,V",
           addVector<dvec2>(app, "--map-offset", object.placement.offset,
                            "what is added to texture coordinates after that (default: 0,0)")
               ->check(numberIn(-kMostRepeats, kMostRepeats)));
    listIn("maps", "N",
           app.add_option("--uv-set", object.uvSet, "which texture coordinates of a glTF file: TEXCOORD_N (default: 0)")
               ->check(CLI::Range(0, 15)));
}

} // namespace relief::app
