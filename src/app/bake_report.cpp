#include "app/bake_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace relief::app {
namespace {

constexpr Word<Addressing> kMapKinds[] = {
    {"texture", Addressing::texture, ""}, {"tiles", Addressing::tiles, ""}, {"faces", Addressing::faces, ""}};

std::string sizeOf(const BakeReport& report) {
    if (report.addressing == Addressing::texture) return fmt::format("{} x {}", report.width, report.height);
    return fmt::format("{} {}, up to {} x {}", report.tileCount, wordOf(kMapKinds, report.addressing), report.width,
                       report.height);
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

} // namespace

std::string describeDistance(const char* name, const SampledDistance& distance, double unit, double diagonal) {
    const auto both = [&](double length) {
        return fmt::format("{:.4g} ({:.4f} %)", length * unit, percent(length * unit, diagonal));
    };
    return fmt::format("{:<18} RMS {}, 95 % within {}, at most {}\n", name, both(distance.rms), both(distance.share95),
                       both(distance.max));
}

nlohmann::json distanceToJson(const SampledDistance& distance, double unit, double diagonal) {
    return {{"rms", distance.rms * unit},
            {"mean", distance.mean * unit},
            {"share95", distance.share95 * unit},
            {"max", distance.max * unit},
            {"rms_percent", percent(distance.rms * unit, diagonal)},
            {"share95_percent", percent(distance.share95 * unit, diagonal)},
            {"max_percent", percent(distance.max * unit, diagonal)}};
}

double BakeReport::rms() const {
    return unit * std::max(certificate.distance.forth.rms, certificate.distance.back.rms);
}

std::string toText(const BakeReport& report) {
    std::string text;
    const BakedHeights& baked = report.baked;
    if (report.isBaked)
        text +=
            fmt::format("{:<18} {}, {} texels on the surface, {} of them voids ({:.2f} %)\n", "map", sizeOf(report),
                        baked.texelCount, baked.voidCount, percent(double(baked.voidCount), double(baked.texelCount)));
    text += fmt::format("{:<18} {:.6g} to {:.6g}; --mid {:.9g} --scale {:.9g}\n", "heights", report.lowest,
                        report.highest, report.mid, report.scale);
    const BakeCertificate& certificate = report.certificate;
    text += describeDistance("surface to sculpt", certificate.distance.forth, report.unit, report.diagonal);
    text += describeDistance("sculpt to surface", certificate.distance.back, report.unit, report.diagonal);
    text += fmt::format("{:<18} {:.3f} % of the area\n", "missed", 100 * certificate.missedShare);
    text += fmt::format("{:<18} {:.3f} % of the area, behind the back of another sheet\n", "wrong sheet",
                        100 * certificate.behindShare);
    text += fmt::format("{:<18} {:.3f} % of the area by curvature, {:.3f} % ({} triangles) by orientation\n", "folded",
                        100 * certificate.foldedShare, 100 * certificate.overturnedShare, certificate.overturnedCount);
    text += fmt::format("{:<18} at most {:.4g} ({:.4f} %) along {} edges\n", "seams", report.seams.max * report.unit,
                        percent(report.seams.max * report.unit, report.diagonal), report.seams.seamEdgeCount);
    text += fmt::format("{:<18} RMS {:.4g}, tolerance {:.4g}\n", report.passes() ? "PASS" : "FAIL", report.rms(),
                        report.tolerance);
    return text;
}

nlohmann::json toJson(const BakeReport& report) {
    const BakeCertificate& certificate = report.certificate;
    // Programs read these names.
    nlohmann::json all{{"cage", report.cage},
                       {"sculpt", report.sculpt},
                       {"sculpt_triangles", report.sculptTriangles},
                       {"map", report.map},
                       {"kind", wordOf(kMapKinds, report.addressing)},
                       {"width", report.width},
                       {"height", report.height},
                       {"mid", report.mid},
                       {"scale", report.scale},
                       {"lowest", report.lowest},
                       {"highest", report.highest},
                       {"diagonal", report.diagonal},
                       {"surface_to_sculpt", distanceToJson(certificate.distance.forth, report.unit, report.diagonal)},
                       {"sculpt_to_surface", distanceToJson(certificate.distance.back, report.unit, report.diagonal)},
                       {"missed_share", certificate.missedShare},
                       {"wrong_sheet_share", certificate.behindShare},
                       {"folded_share", certificate.foldedShare},
                       {"overturned_share", certificate.overturnedShare},
                       {"overturned_triangles", certificate.overturnedCount},
                       {"certificate_triangles", certificate.triangleCount},
                       {"certificate_rate", certificate.rate},
                       {"seam_gap", report.seams.max * report.unit},
                       {"seam_edges", report.seams.seamEdgeCount},
                       {"rms", report.rms()},
                       {"tolerance", report.tolerance},
                       {"passes", report.passes()},
                       {"read_ms", 1e3 * report.readSeconds},
                       {"bake_ms", 1e3 * report.bakeSeconds},
                       {"certify_ms", 1e3 * report.certifySeconds}};
    if (report.addressing != Addressing::texture) all["tiles"] = report.tileCount;
    if (report.isBaked)
        all.update({{"texels", report.baked.texelCount},
                    {"voids", report.baked.voidCount},
                    {"samples", report.baked.sampleCount},
                    {"missed_samples", report.baked.missCount},
                    {"wrong_sheet_samples", report.baked.behindCount},
                    {"cage_inside_samples", report.baked.insideCount},
                    {"overlapping_samples", report.overlap.sampleCount}});
    return all;
}

} // namespace relief::app
