#include <charconv>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/output.h"
#include "app/picture_options.h"

namespace relief::app {
namespace {

struct SampleArgs {
    ObjectDesc object;
    Output output;
    NormalKind normal = SampleOptions().normal;
    std::string points, target, device;
};

constexpr std::string_view kHeader = "face,u,v,px,py,pz,pux,puy,puz,pvx,pvy,pvz,nx,ny,nz,h,qx,qy,qz,mx,my,mz\n";
constexpr std::size_t kRowsAtOnce = 1u << 18; // keeps the device's buffers below 40 MB

template <typename T>
bool parseField(const char*& at, const char* end, T& value) {
    while (at != end && *at == ' ') ++at;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return false;
    for (at = next; at != end && (*at == ' ' || *at == '\r'); ++at) {
    }
    return true;
}

bool parseRow(std::string_view line, SampleQuery& query) {
    const char *at = line.data(), *end = at + line.size();
    return parseField(at, end, query.face) && at != end && *at++ == ',' && parseField(at, end, query.uv.x) &&
           at != end && *at++ == ',' && parseField(at, end, query.uv.y) && at == end;
}

/// Rows face,u,v; a first line that does not start with a number is a header.
std::vector<SampleQuery> readPoints(const std::string& path) {
    const std::string text = readFile(path);
    std::vector<SampleQuery> queries;
    std::size_t lineNumber = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        at = end + 1;
        ++lineNumber;
        const bool isHeader = lineNumber == 1 && line.starts_with("face");
        if (isHeader || line.empty() || line == "\r") continue;
        SampleQuery query{};
        if (!parseRow(line, query))
            fail(Failure::input, "{}:{}: a row is face,u,v, for example 12,0.5,0.25", path, lineNumber);
        queries.push_back(query);
    }
    return queries;
}

/// Writes rows in world coordinates. Nine digits give each float back; positions far from the origin take the digits of
/// a double.
class Rows {
public:
    explicit Rows(const Coordinates& coordinates) : coordinates_(coordinates) {}

    void add(const SampleQuery& query, const SampleResult& r) {
        const double unit = coordinates_.unit;
        text_ += fmt::format("{},{:.9g},{:.9g}", query.face, query.uv.x, query.uv.y);
        put(coordinates_.toWorld(r.p), positionDigits_);
        for (const dvec3& v : {unit * dvec3(r.pu), unit * dvec3(r.pv), dvec3(r.n)}) put(v, kFloatDigits);
        text_ += fmt::format(",{:.9g}", unit * r.h);
        put(coordinates_.toWorld(r.q), positionDigits_);
        put(r.m, kFloatDigits);
        text_ += '\n';
    }
    [[nodiscard]] std::string takeText() { return std::move(text_); }

private:
    static constexpr int kFloatDigits = 9, kDoubleDigits = 17;

    void put(const dvec3& v, int digits) {
        fmt::format_to(std::back_inserter(text_), ",{:.{}g},{:.{}g},{:.{}g}", v.x, digits, v.y, digits, v.z, digits);
    }

    Coordinates coordinates_;
    int positionDigits_ = coordinates_.isIdentity() ? kFloatDigits : kDoubleDigits;
    std::string text_{kHeader};
};

/// One CSV row for each query, with the device's frames.
Rows sampleRows(Device& device, const SurfaceModel& model, const std::vector<SampleQuery>& queries,
                const SampleArgs& args, const Coordinates& coordinates) {
    SurfaceSampler sampler(device);
    Progress progress("sampling", queries.size(), args.output.progress);
    Rows rows(coordinates);
    for (std::size_t first = 0; first < queries.size(); first += kRowsAtOnce) {
        const auto part = std::span(queries).subspan(first, std::min(kRowsAtOnce, queries.size() - first));
        const std::vector<SampleResult> results =
            sampler.sample(model, part, {.firstRow = first, .normal = args.normal});
        for (std::size_t i = 0; i < part.size(); ++i) rows.add(part[i], results[i]);
        progress.advance(part.size());
    }
    return rows;
}

int sample(const SampleArgs& args) {
    // Mistakes in the command line come before those in files.
    std::vector<std::string> inputs = listFiles(args.object);
    inputs.push_back(args.points);
    checkOutput(args.target, inputs);
    const std::vector<SampleQuery> queries = readPoints(args.points);
    LoadedObject object = load(args.object, CageState::posed, makeWarn(args.output.isQuiet));
    if (object.dense)
        fail(Failure::usage, "{}: points lie on a subdivision surface; name its --scheme", args.object.cage);

    // Queries that name no point of the surface are mistakes in their file.
    Device device({.name = args.device});
    measureFunction(device, object, args.object.height, {{object.time}}, makeWarn(args.output.isQuiet));
    SurfaceModel model = makeSurfaceModel(device, object);
    keepRestPose(device, model, object, HeightSpace::absolute);
    std::string text;
    try {
        text = sampleRows(device, model, queries, args, object.coordinates()).takeText();
    } catch (const Error& error) {
        if (error.failure != Failure::input) throw;
        fail(error.failure, "{}: {}", args.points, error.what());
    }
    writeFile(args.target, text);
    if (args.output.isJson)
        printJson({{"rows", queries.size()}, {"device", device.traits().name}, {"output", args.target}});
    else if (!args.output.isQuiet)
        std::cerr << fmt::format("{}: {} points on {}\n", args.target, queries.size(), device.traits().name);
    checkValidation(device);
    return 0;
}

} // namespace

Run addSample(CLI::App& app) {
    auto args = std::make_shared<SampleArgs>();
    addObject(app, args->object);
    addTime(app, args->object.motion);
    app.add_option("--at", args->points,
                   "points to evaluate, rows face,u,v: number of the ptex face from 0, coordinates 0..1 within it")
        ->required()
        ->option_text("POINTS.csv");
    app.add_option("-o,--output", args->target, "table to write, one row per point")->required()->option_text("F.csv");
    addNormal(app, args->normal);
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer("columns: p point of the smooth surface, pu and pv its derivatives, n its normal, h height, q displaced "
               "point,\n"
               "m its normal\n"
               "example:\n"
               "  relief sample cage.obj --height map.exr --at points.csv -o frames.csv");
    return [args] { return sample(*args); };
}

} // namespace relief::app
