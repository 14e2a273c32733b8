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

void explain(const char* help) {
    if (ImGui::IsItemHovered() && *help != 0) ImGui::SetTooltip("%s", help);
}

bool button(PanelWishes& wishes, const char* label) {
    const bool isPressed = ImGui::Button(label);
    keepPlace(wishes, label);
    return isPressed;
}

bool tick(PanelWishes& wishes, const char* label, bool& value) {
    const bool isChanged = ImGui::Checkbox(label, &value);
    keepPlace(wishes, label);
    return isChanged;
}

/// A row of a list, whose place is kept as "list: word".
bool pick(PanelWishes& wishes, const char* list, const char* word, bool isSelected, const char* help = "") {
    const bool isPicked = ImGui::Selectable(word, isSelected);
    keepPlace(wishes, fmt::format("{}: {}", list, word));
    explain(help);
    return isPicked;
}

bool openList(PanelWishes& wishes, const char* label, const char* shown) {
    const bool isOpen = ImGui::BeginCombo(label, shown);
    if (!isOpen) keepPlace(wishes, label, ImGui::CalcItemWidth());
    return isOpen;
}

/// A list of a table's words with their help. Returns whether another one was picked.
template <typename Value, std::size_t kCount>
bool choose(PanelWishes& wishes, const char* label, Value& value, const Word<Value> (&table)[kCount]) {
    if (!openList(wishes, label, wordOf(table, value))) return false;
    bool isPicked = false;
    for (const Word<Value>& row : table)
        if (pick(wishes, label, row.word, row.value == value, row.help))
            isPicked = row.value != value, value = row.value;
    ImGui::EndCombo();
    return isPicked;
}

bool slide(PanelWishes& wishes, const char* label, double& value, double low, double high, const char* format = "%.2f",
           int flags = 0) {
    auto number = float(value);
    const bool isChanged = ImGui::SliderFloat(label, &number, float(low), float(high), format, flags);
    keepPlace(wishes, label, ImGui::CalcItemWidth());
    if (isChanged) value = number;
    return isChanged;
}

/// A number of any size: dragging changes it by a hundredth of itself per pixel.
bool dragNumber(PanelWishes& wishes, const char* label, double& value) {
    auto number = float(value);
    const float speed = std::max(0.01f * std::abs(number), 1e-4f);
    const bool isChanged = ImGui::DragFloat(label, &number, speed, 0, 0, "%.4g");
    keepPlace(wishes, label, ImGui::CalcItemWidth());
    if (isChanged) value = number;
    return isChanged;
}

bool section(PanelWishes& wishes, const char* name, bool isOpen) {
    const bool isShown = ImGui::CollapsingHeader(name, isOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    keepPlace(wishes, name);
    return isShown;
}

void makeView(ViewState& state, PanelWishes& wishes) {
    if (!section(wishes, "View", true)) return;
    bool changes = choose(wishes, "show", state.look.show, kShows);
    tick(wishes, "cage", state.showsCage);
    ImGui::SameLine();
    if (tick(wishes, "freeze rates", state.isFrozen)) changes = true;
    explain("rates stay those of the camera as it is now, for looking at them from elsewhere");
    if (button(wishes, "frame")) wishes.frames = true;
    const std::pair<const char*, dvec2> sides[] = {{"front", {0, 0}}, {"right", {90, 0}}, {"top", {0, 90}}};
    for (const auto& [name, from] : sides) {
        ImGui::SameLine();
        if (button(wishes, name)) wishes.looksFrom = from;
    }
    ImGui::SameLine();
    bool isParallel = state.look.scene.camera.fieldOfView == kParallelView;
    if (tick(wishes, "parallel", isParallel)) wishes.togglesParallel = true;
    if (choose(wishes, "split", state.split, kSplits)) changes = true;
    if (state.split != SplitKind::off && tick(wishes, "difference, 8 times", state.showsDifference)) changes = true;
    wishes.changesPicture |= changes;
}

void makeHeights(ViewState& state, const ViewFacts& facts, PanelWishes& wishes) {
    HeightDesc& height = state.look.scene.object.height;
    if ((height.path.empty() && height.function.empty()) || !section(wishes, "Heights", true)) return;
    bool changes = choose(wishes, "detail", height.detail, kDetails);
    double scale = height.scale.value_or(1);
    double mid = height.mid.value_or(facts.scene != nullptr ? facts.scene->mid() : 0);
    if (dragNumber(wishes, "scale", scale)) changes = true, height.scale = scale;
    explain("cage units per unit of stored height");
    if (dragNumber(wishes, "midlevel", mid)) changes = true, height.mid = mid;
    explain("stored height that displaces nothing");
    wishes.changesObject |= changes;
    wishes.changesPicture |= choose(wishes, "normal", state.look.triangles.normal, kNormals);
}

void makeTriangles(ViewState& state, PanelWishes& wishes) {
    if (!section(wishes, "Triangles", true)) return;
    TriangleOptions& triangles = state.look.triangles;
    bool isUniform = triangles.rate.has_value();
    bool changes = tick(wishes, "same rate everywhere", isUniform);
    if (changes) triangles.rate = isUniform ? std::optional(8) : std::nullopt;
    if (triangles.rate) {
        if (ImGui::SliderInt("rate", &*triangles.rate, 1, 64)) changes = true;
        keepPlace(wishes, "rate", ImGui::CalcItemWidth());
    } else {
        changes |= slide(wishes, "edge pixels", triangles.edgePixels, 0.5, 64, "%.1f", ImGuiSliderFlags_Logarithmic);
    }
    changes |= choose(wishes, "spacing", triangles.spacing, kSpacings);
    if (openList(wishes, "path", state.look.path ? wordOf(kPaths, *state.look.path) : "auto")) {
        if (pick(wishes, "path", "auto", !state.look.path, "what suits the device"))
            changes = true, state.look.path.reset();
        for (const Word<Path>& row : kPaths)
            if (pick(wishes, "path", row.word, state.look.path == row.value, row.help))
                changes = true, state.look.path = row.value;
        ImGui::EndCombo();
    }
    wishes.changesPicture |= changes;
}

void makeLight(ViewState& state, PanelWishes& wishes) {
    if (!section(wishes, "Camera and light", false)) return;
    SceneDesc& scene = state.look.scene;
    bool changes = slide(wishes, "field of view", scene.camera.fieldOfView, 1, 120, "%.0f deg");
    changes |= slide(wishes, "exposure", state.look.finish.exposure, -4, 4, "%+.2f stops");
    dvec2 key = scene.lighting.key.value_or(
        dvec2(scene.camera.azimuth + Lighting().keyAzimuth - CameraOptions().azimuth, Lighting().keyElevation));
    bool turns = slide(wishes, "light from", key.x, -360, 360, "%.0f deg");
    turns |= slide(wishes, "light above", key.y, -90, 90, "%.0f deg");
    if (turns) scene.lighting.key = key;
    changes |= slide(wishes, "environment", scene.lighting.environmentAzimuth, -360, 360, "%.0f deg");
    changes |= tick(wishes, "shadows", scene.lighting.castsShadows);
    auto& material = scene.object.material;
    const bool wasWater = scene.shading.shading == Shading::water;
    changes |= choose(wishes, "shading", scene.shading.shading, kShadings);
    // Water wants a sharper environment, which is loaded with the object.
    wishes.changesObject |= wasWater != (scene.shading.shading == Shading::water);
    changes |= ImGui::SliderFloat("roughness", &material.roughness, 0.05f, 1);
    keepPlace(wishes, "roughness", ImGui::CalcItemWidth());
    changes |= slide(wishes, "occlusion", scene.lighting.occlusionRadius, 0, 0.5);
    explain("how far away the surface hides the environment from itself, as a share of the object's size");
    changes |= choose(wishes, "filter", state.look.filter, kFilters);
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
            if (!value.number ||
                !dragNumber(wishes, fmt::format("{} {}", all[i].name, value.name).c_str(), *value.number))
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
    if (deformers.empty() || !section(wishes, "Deformers", true)) return;
    ImGui::PushItemWidth(-1);
    if (ImGui::InputText("##deform", &deformers, ImGuiInputTextFlags_EnterReturnsTrue)) wishes.changesObject = true;
    keepPlace(wishes, "expression");
    ImGui::PopItemWidth();
    explain("an expression of --deform; Enter applies it");
    makeDeformerValues(deformers, wishes);
}

void makeMeasured(const ViewFacts& facts, PanelWishes& wishes) {
    if (!section(wishes, "Measured", true) || facts.stats == nullptr || facts.scene == nullptr) return;
    const FrameStats& stats = *facts.stats;
    ImGui::Text("%.2f M triangles, rate up to %u", 1e-6 * double(stats.triangleCount), stats.maxRate);
    ImGui::Text("%.2f M points of the surface", 1e-6 * double(stats.vertexCount));
    explain("that were evaluated: each once per picture by dicing, else once per pass and triangle");
    ImGui::Text("picture  %.1f ms   95 %%: %.1f", facts.pictureTimes->median(), facts.pictureTimes->high());
    for (const auto& [name, times] : facts.passes)
        if (times != nullptr && times->high() > 0)
            ImGui::TextDisabled("  %s  %.1f ms   95 %%: %.1f", name, times->median(), times->high());
    const std::uint64_t dense = denseBytes(stats.vertexCount, stats.triangleCount);
    const std::uint64_t maps = facts.scene->mapBytes();
    ImGui::Text("surface %s, maps %s", humanBytes(facts.scene->modelBytes() - maps).c_str(), humanBytes(maps).c_str());
    ImGui::Text("as a dense mesh  %s", humanBytes(dense).c_str());
    if (facts.scene->isMoving()) ImGui::Text("sent per frame  %s", humanBytes(facts.scene->uploadedBytes()).c_str());
    const auto share = facts.heapBytes > 0 ? float(double(facts.deviceBytes) / double(facts.heapBytes)) : 0;
    const std::string text = fmt::format("{} of {}", humanBytes(facts.deviceBytes), humanBytes(facts.heapBytes));
    ImGui::ProgressBar(share, ImVec2(-1, 0), text.c_str());
    explain("memory of the device that buffers and images take");
}

void makeFiles(const ViewState& state, const ViewFacts& facts, PanelWishes& wishes) {
    if (button(wishes, "copy command")) wishes.copies = true;
    explain(facts.command.c_str());
    ImGui::SameLine();
    if (button(wishes, "screenshot")) wishes.shoots = true;
    ImGui::SameLine();
    if (button(wishes, "turntable")) wishes.exports = true;
    explain("writes turntable-1.mp4 or the next free name: 72 frames of one turn, by relief animate");
    if (button(wishes, "certificate")) wishes.checks = true;
    explain("what relief check finds of this surface and pose, in the background");
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    if (openList(wishes, "##recent", "recent files")) {
        for (const std::string& path : state.recent)
            if (pick(wishes, "recent", path.c_str(), false)) wishes.opens = path;
        ImGui::EndCombo();
    }
    ImGui::PopItemWidth();
    if (!section(wishes, "Warnings", false) || facts.scene == nullptr) return;
    for (const std::string& line : facts.scene->warnings()) ImGui::TextWrapped("%s", line.c_str());
    if (facts.scene->warnings().empty()) ImGui::TextDisabled("none");
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

void keepPlace(PanelWishes& wishes, const std::string& name, float frameWidth) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (name == wishes.reveals) ImGui::SetScrollHereY();
    wishes.places[name] = {{low.x, low.y}, {frameWidth > 0 ? std::min(high.x, low.x + frameWidth) : high.x, high.y}};
}

PanelWishes makePanels(ViewState& state, const ViewFacts& facts, const ivec2& size) {
    PanelWishes wishes{.reveals = state.reveals};
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
        makeHeights(state, facts, wishes);
        makeTriangles(state, wishes);
        makeLight(state, wishes);
        makeMotion(state, wishes);
        makeMeasured(facts, wishes);
        makeFiles(state, facts, wishes);
        ImGui::PopItemWidth();
        ImGui::End();
    }
    makeOverlays(state, facts, size, wishes);
    return wishes;
}

} // namespace relief
