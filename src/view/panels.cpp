#include "view/panels.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "view/events.h"
#include "view/keys.h"
#include "view/orbit.h"

namespace relief {
namespace {

constexpr float kPanelWidth = 310, kMargin = 12;

void explain(const char* help) {
    if (ImGui::IsItemHovered() && *help != 0) ImGui::SetTooltip("%s", help);
}

/// A list of a table's words with their help. Returns whether another one was picked.
template <typename Value, std::size_t kCount>
bool choose(const char* label, Value& value, const Word<Value> (&table)[kCount]) {
    bool isPicked = false;
    if (ImGui::BeginCombo(label, wordOf(table, value))) {
        for (const Word<Value>& row : table) {
            if (ImGui::Selectable(row.word, row.value == value)) isPicked = row.value != value, value = row.value;
            explain(row.help);
        }
        ImGui::EndCombo();
    }
    return isPicked;
}

bool slide(const char* label, double& value, double low, double high, const char* format = "%.2f") {
    auto number = float(value);
    if (!ImGui::SliderFloat(label, &number, float(low), float(high), format)) return false;
    value = number;
    return true;
}

/// A number of any size: dragging changes it by a hundredth of itself per pixel.
bool dragNumber(const char* label, double& value) {
    auto number = float(value);
    const float speed = std::max(0.01f * std::abs(number), 1e-4f);
    if (!ImGui::DragFloat(label, &number, speed, 0, 0, "%.4g")) return false;
    value = number;
    return true;
}

bool section(const char* name, bool isOpen) {
    return ImGui::CollapsingHeader(name, isOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void makeView(ViewState& state, PanelWishes& wishes) {
    if (!section("View", true)) return;
    bool changes = choose("show", state.look.show, kShows);
    ImGui::Checkbox("cage", &state.showsCage);
    ImGui::SameLine();
    if (ImGui::Checkbox("freeze rates", &state.isFrozen)) changes = true;
    explain("rates stay those of the camera as it is now, for looking at them from elsewhere");
    if (ImGui::Button("frame")) wishes.frames = true;
    const std::pair<const char*, double> sides[] = {{"front", 0}, {"right", 90}, {"back", 180}};
    for (const auto& [name, azimuth] : sides) {
        ImGui::SameLine();
        if (ImGui::Button(name)) wishes.frontOf = azimuth;
    }
    if (choose("split", state.split, kSplits)) changes = true;
    if (state.split != SplitKind::off && ImGui::Checkbox("difference, 8 times", &state.showsDifference)) changes = true;
    wishes.changesPicture |= changes;
}

void makeHeights(ViewState& state, PanelWishes& wishes) {
    HeightDesc& height = state.look.scene.object.height;
    if ((height.path.empty() && height.function.empty()) || !section("Heights", true)) return;
    bool changes = choose("detail", height.detail, kDetails);
    double scale = height.scale.value_or(1), mid = height.mid.value_or(0);
    if (dragNumber("scale", scale)) changes = true, height.scale = scale;
    explain("cage units per unit of stored height");
    if (dragNumber("midlevel", mid)) changes = true, height.mid = mid;
    explain("stored height that displaces nothing");
    wishes.changesObject |= changes;
    wishes.changesPicture |= choose("normal", state.look.triangles.normal, kNormals);
}

void makeTriangles(ViewState& state, PanelWishes& wishes) {
    if (!section("Triangles", true)) return;
    TriangleOptions& triangles = state.look.triangles;
    bool isUniform = triangles.rate.has_value();
    bool changes = ImGui::Checkbox("same rate everywhere", &isUniform);
    if (changes) triangles.rate = isUniform ? std::optional(8) : std::nullopt;
    if (triangles.rate) {
        if (ImGui::SliderInt("rate", &*triangles.rate, 1, 64)) changes = true;
    } else if (auto pixels = float(triangles.edgePixels);
               ImGui::SliderFloat("edge pixels", &pixels, 0.5f, 64, "%.1f", ImGuiSliderFlags_Logarithmic)) {
        triangles.edgePixels = pixels;
        changes = true;
    }
    changes |= choose("spacing", triangles.spacing, kSpacings);
    if (ImGui::BeginCombo("path", state.look.path ? wordOf(kPaths, *state.look.path) : "auto")) {
        if (ImGui::Selectable("auto", !state.look.path)) changes = true, state.look.path.reset();
        explain("what suits the device");
        for (const Word<Path>& row : kPaths) {
            if (ImGui::Selectable(row.word, state.look.path == row.value)) changes = true, state.look.path = row.value;
            explain(row.help);
        }
        ImGui::EndCombo();
    }
    wishes.changesPicture |= changes;
}

void makeLight(ViewState& state, PanelWishes& wishes) {
    if (!section("Camera and light", false)) return;
    SceneDesc& scene = state.look.scene;
    bool changes = slide("field of view", scene.camera.fieldOfView, 1, 120, "%.0f deg");
    changes |= slide("exposure", state.look.finish.exposure, -4, 4, "%+.2f stops");
    dvec2 key = scene.lighting.key.value_or(
        dvec2(scene.camera.azimuth + Lighting().keyAzimuth - CameraOptions().azimuth, Lighting().keyElevation));
    bool turns = slide("light from", key.x, -360, 360, "%.0f deg");
    turns |= slide("light above", key.y, -90, 90, "%.0f deg");
    if (turns) scene.lighting.key = key;
    changes |= slide("environment", scene.lighting.environmentAzimuth, -360, 360, "%.0f deg");
    changes |= ImGui::Checkbox("shadows", &scene.lighting.castsShadows);
    auto& material = scene.object.material;
    changes |= choose("shading", scene.shading.shading, kShadings);
    changes |= ImGui::SliderFloat("roughness", &material.roughness, 0.05f, 1);
    changes |= slide("occlusion", scene.lighting.occlusionRadius, 0, 0.5);
    explain("how far away the surface hides the environment from itself, as a share of the object's size");
    changes |= choose("filter", state.look.filter, kFilters);
    wishes.changesPicture |= changes || turns;
}

/// Every value of an expression that is a number can be dragged; what is typed may not be one yet.
void makeDeformerValues(std::string& deformers, PanelWishes& wishes) {
    std::vector<DeformerText> all;
    try {
        all = parseDeformers(deformers);
    } catch (const Error&) {
        return;
    }
    bool isChanged = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
        ImGui::PushID(int(i));
        for (DeformerValue& value : all[i].values) {
            if (!value.number || !dragNumber(fmt::format("{} {}", all[i].name, value.name).c_str(), *value.number))
                continue;
            value.text = fmt::format("{:.6g}", *value.number), value.isGiven = true;
            isChanged = true;
        }
        ImGui::PopID();
    }
    if (!isChanged) return;
    deformers = toExpression(all);
    wishes.changesObject = true;
}

void makeMotion(ViewState& state, PanelWishes& wishes) {
    std::string& deformers = state.look.scene.object.motion.deformers;
    if (deformers.empty() || !section("Deformers", true)) return;
    ImGui::PushItemWidth(-1);
    if (ImGui::InputText("##deform", &deformers, ImGuiInputTextFlags_EnterReturnsTrue)) wishes.changesObject = true;
    ImGui::PopItemWidth();
    explain("an expression of --deform; Enter applies it");
    makeDeformerValues(deformers, wishes);
}

void makeMeasured(const ViewFacts& facts) {
    if (!section("Measured", true) || facts.stats == nullptr || facts.scene == nullptr) return;
    const FrameStats& stats = *facts.stats;
    ImGui::Text("%.2f M triangles, rate up to %u", 1e-6 * double(stats.triangleCount), stats.maxRate);
    ImGui::Text("picture  %.1f ms   95 %%: %.1f", facts.pictureTimes->median(), facts.pictureTimes->high());
    for (const auto& [name, times] : facts.passes)
        if (times != nullptr && times->high() > 0)
            ImGui::TextDisabled("  %s  %.1f ms   95 %%: %.1f", name, times->median(), times->high());
    const std::uint64_t dense = denseBytes(stats.vertexCount, stats.triangleCount);
    ImGui::Text("surface and maps  %s", humanBytes(facts.scene->modelBytes()).c_str());
    ImGui::Text("as a dense mesh  %s", humanBytes(dense).c_str());
    if (facts.scene->isMoving()) ImGui::Text("sent per frame  %s", humanBytes(facts.scene->uploadedBytes()).c_str());
    const auto share = facts.heapBytes > 0 ? float(double(facts.deviceBytes) / double(facts.heapBytes)) : 0;
    const std::string text = fmt::format("{} of {}", humanBytes(facts.deviceBytes), humanBytes(facts.heapBytes));
    ImGui::ProgressBar(share, ImVec2(-1, 0), text.c_str());
    explain("memory of the device that buffers and images take");
}

void makeFiles(const ViewState& state, const ViewFacts& facts, PanelWishes& wishes) {
    if (ImGui::Button("copy command")) wishes.copies = true;
    explain(facts.command.c_str());
    ImGui::SameLine();
    if (ImGui::Button("screenshot")) wishes.shoots = true;
    ImGui::SameLine();
    if (ImGui::Button("turntable")) wishes.exports = true;
    explain("writes turntable-1.mp4 or the next free name: 72 frames of one turn, by relief animate");
    if (ImGui::Button("certificate")) wishes.checks = true;
    explain("what relief check finds of this surface and pose, in the background");
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    if (ImGui::BeginCombo("##recent", "recent files")) {
        for (const std::string& path : state.recent)
            if (ImGui::Selectable(path.c_str())) wishes.opens = path;
        ImGui::EndCombo();
    }
    ImGui::PopItemWidth();
    if (!section("Warnings", false) || facts.scene == nullptr) return;
    for (const std::string& line : facts.scene->warnings()) ImGui::TextWrapped("%s", line.c_str());
    if (facts.scene->warnings().empty()) ImGui::TextDisabled("none");
}

/// Play, the frames, and their loop, along the lower side.
void makeTimeLine(ViewState& state, const ViewFacts& facts, const ivec2& size, PanelWishes& wishes) {
    if (facts.scene == nullptr || !facts.scene->isMoving()) return;
    const std::vector<int>& frames = facts.scene->frames();
    const float left = state.showsPanels ? kPanelWidth + 2 * kMargin : kMargin;
    ImGui::SetNextWindowPos({left, float(size.y) - 58});
    ImGui::SetNextWindowSize({std::max(200.0f, float(size.x) - left - kMargin), 46});
    ImGui::Begin("time", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    if (ImGui::Button(state.isPlaying ? "stop" : "play")) state.isPlaying = !state.isPlaying;
    ImGui::SameLine();
    ImGui::Checkbox("loop", &state.loops);
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    int frame = state.look.frame;
    if (ImGui::SliderInt("##frame", &frame, frames.front(), frames.back(), "frame %d")) wishes.seeks = frame;
    ImGui::PopItemWidth();
    ImGui::End();
}

void makeBanner(const ViewState& state, const ViewFacts& facts, const ivec2& size) {
    const bool isError = !state.error.empty();
    const std::string text = isError ? state.error : facts.isLoading ? "reading files ..." : state.notice;
    if (text.empty()) return;
    const float left = state.showsPanels ? kPanelWidth + 2 * kMargin : kMargin;
    const float width = std::max(120.0f, float(size.x) - left - kMargin);
    const float wanted = ImGui::CalcTextSize(text.c_str()).x + 26;
    ImGui::SetNextWindowPos({left, kMargin});
    ImGui::SetNextWindowSize({std::min(width, wanted), 0});
    if (isError) ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.45f, 0.10f, 0.08f, 0.94f});
    ImGui::Begin("banner", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::End();
    if (isError) ImGui::PopStyleColor();
}

void makeHelp(const ViewState& state, const ivec2& size) {
    if (!state.showsHelp) return;
    ImGui::SetNextWindowPos({0.5f * float(size.x), 0.5f * float(size.y)}, 0, {0.5f, 0.5f});
    ImGui::Begin("keys", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
    const auto row = [](const char* name, const char* help) {
        ImGui::TextColored({0.93f, 0.70f, 0.42f, 1}, "%s", name);
        ImGui::SameLine(90);
        ImGui::TextUnformatted(help);
    };
    for (const Word<Button>& button : kButtons) row(button.word, button.help);
    row("wheel", "zoom to the cursor");
    row("drop", "a mesh, an environment (.hdr), a height map, a height function (.glsl)");
    for (const Word<int>& key : kKeys)
        if (*key.help != 0) row(key.word, key.help);
    ImGui::End();
}

/// Columns of the certificate align in a monospaced font only.
void makeCertificate(ViewState& state, const ivec2& size) {
    if (state.certificate.empty()) return;
    ImGui::SetNextWindowPos({0.5f * float(size.x), 0.5f * float(size.y)}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::Begin("certificate", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushFont(ImGui::GetIO().Fonts->Fonts.back());
    ImGui::TextUnformatted(state.certificate.c_str());
    ImGui::PopFont();
    if (ImGui::Button("close")) state.certificate.clear();
    ImGui::End();
}

ImU32 creaseColor(float sharpness) {
    const float t = std::clamp(sharpness / 10, 0.0f, 1.0f);
    return ImGui::GetColorU32(ImVec4(1, 0.85f - 0.70f * t, 0.15f, 0.95f));
}

} // namespace

void Times::add(double milliseconds) { values_[count_++ % values_.size()] = milliseconds; }

double Times::quantile(double share) const {
    const std::size_t count = std::min(count_, values_.size());
    if (count == 0) return 0;
    std::vector<double> sorted(values_.begin(), values_.begin() + std::ptrdiff_t(count));
    std::ranges::sort(sorted);
    return sorted[std::min(count - 1, std::size_t(share * double(count)))];
}

PanelWishes makePanels(ViewState& state, const ViewFacts& facts, const ivec2& size) {
    PanelWishes wishes;
    if (state.showsPanels) {
        // One panel at the left edge, as high as its contents and no higher than the window.
        ImGui::SetNextWindowPos({kMargin, kMargin});
        ImGui::SetNextWindowSizeConstraints({kPanelWidth, 0},
                                            {kPanelWidth, std::max(80.0f, float(size.y) - 2 * kMargin)});
        ImGui::Begin("relief", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::PushItemWidth(150);
        ImGui::TextColored({0.93f, 0.70f, 0.42f, 1}, "relief");
        ImGui::SameLine();
        ImGui::TextDisabled("%s   ? for keys", facts.isCoarse ? "coarse" : "full");
        explain(facts.device.c_str());
        // In the order of the data flow: what is seen, heights, triangles, light, time, and what it cost.
        makeView(state, wishes);
        makeHeights(state, wishes);
        makeTriangles(state, wishes);
        makeLight(state, wishes);
        makeMotion(state, wishes);
        makeMeasured(facts);
        makeFiles(state, facts, wishes);
        ImGui::PopItemWidth();
        ImGui::End();
    }
    makeTimeLine(state, facts, size, wishes);
    makeBanner(state, facts, size);
    makeCertificate(state, size);
    makeHelp(state, size);
    return wishes;
}

void drawCage(const ShownScene& scene, const Camera& camera, const ivec2& size) {
    constexpr std::size_t kMostEdges = 100'000; // more would be a grey mist
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const std::vector<vec3>& points = scene.cagePoints();
    const std::size_t count = std::min(scene.edges().size(), kMostEdges);
    for (std::size_t i = 0; i < count; ++i) {
        const CageEdge& edge = scene.edges()[i];
        const auto a = toPixel(camera, dvec3(points[edge.a]), size), b = toPixel(camera, dvec3(points[edge.b]), size);
        if (!a || !b) continue;
        const bool isCrease = edge.sharpness > 0;
        list.AddLine({float(a->x), float(a->y)}, {float(b->x), float(b->y)},
                     isCrease ? creaseColor(edge.sharpness) : IM_COL32(255, 255, 255, 110), isCrease ? 2.0f : 1.0f);
    }
}

void drawDivider(const ViewState& state, const ivec2& size) {
    if (state.split == SplitKind::off) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto x = float(state.divider * size.x), middle = 0.5f * float(size.y);
    list.AddLine({x, 0}, {x, float(size.y)}, IM_COL32(255, 255, 255, 200), 2);
    list.AddCircleFilled({x, middle}, 7, IM_COL32(255, 255, 255, 230));
    const auto label = [&](const std::string& text, float from) {
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
        const ImVec2 at(from < 0 ? x - extent.x - 22 : x + 22, float(size.y) - 92);
        list.AddRectFilled({at.x - 8, at.y - 5}, {at.x + extent.x + 8, at.y + extent.y + 5}, IM_COL32(28, 31, 36, 210),
                           5);
        list.AddText(at, IM_COL32(240, 240, 240, 255), text.c_str());
    };
    label(state.split == SplitKind::smooth || state.split == SplitKind::bump
              ? wordOf(kDetails, state.look.scene.object.height.detail)
              : "as set",
          -1);
    label(state.showsDifference ? "difference" : wordOf(kSplits, state.split), 1);
}

} // namespace relief
