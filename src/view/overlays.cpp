// What lies over the picture besides the panel: the time line, messages, help, the cage, the divider.
#include "view/panels.h"

#include <algorithm>

#include <imgui.h>

#include "view/events.h"
#include "view/keys.h"
#include "view/orbit.h"

namespace relief {
namespace {

/// Play, the frames, and their loop, along the lower side.
void makeTimeLine(ViewState& state, const ViewFacts& facts, const ivec2& size, PanelWishes& wishes) {
    if (facts.scene == nullptr || !facts.scene->isMoving()) return;
    const std::vector<int>& frames = facts.scene->frames();
    const float left = state.showsPanels ? kPanelWidth + 2 * kMargin : kMargin;
    ImGui::SetNextWindowPos({left, float(size.y) - 58});
    ImGui::SetNextWindowSize({std::max(200.0f, float(size.x) - left - kMargin), 46});
    ImGui::Begin("time", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
    if (ImGui::Button(state.isPlaying ? "stop" : "play")) wishes.plays = true;
    keepPlace(wishes, "play");
    ImGui::SameLine();
    ImGui::Checkbox("loop", &state.loops);
    keepPlace(wishes, "loop");
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    int frame = state.look.frame;
    if (ImGui::SliderInt("##frame", &frame, frames.front(), frames.back(), "frame %d")) wishes.seeks = frame;
    keepPlace(wishes, "time");
    ImGui::PopItemWidth();
    ImGui::End();
}

void makeBanner(const ViewState& state, const ViewFacts& facts, const ivec2& size) {
    const bool isError = !state.error.empty();
    const bool isFunction = !state.look.scene.object.height.function.empty();
    const char* loading = isFunction ? "compiling the height function ..." : "reading files ...";
    const std::string text = isError ? state.error : facts.isLoading ? loading : state.notice;
    if (text.empty()) return;
    const float left = state.showsPanels ? kPanelWidth + 2 * kMargin : kMargin;
    const float width = std::max(120.0f, float(size.x) - left - kMargin);
    const float wanted = ImGui::CalcTextSize(text.c_str()).x + 26;
    ImGui::SetNextWindowPos({left, kMargin});
    ImGui::SetNextWindowSize({std::min(width, wanted), 0});
    if (isError) ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.45f, 0.10f, 0.08f, 0.94f});
    // It comes and goes by itself: a list or a text field that is open stays so.
    ImGui::Begin("banner", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::End();
    if (isError) ImGui::PopStyleColor();
}

void makeHelp(const ViewState& state, const ivec2& size) {
    if (!state.showsHelp) return;
    // As high as the list, or as the window, and scrolled there.
    ImGui::SetNextWindowPos({0.5f * float(size.x), 0.5f * float(size.y)}, 0, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {float(size.x), std::max(80.0f, float(size.y) - 2 * kMargin)});
    ImGui::SetNextWindowBgAlpha(0.98f);
    ImGui::Begin("keys", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize);
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

void makeOverlays(ViewState& state, const ViewFacts& facts, const ivec2& size, PanelWishes& wishes) {
    makeTimeLine(state, facts, size, wishes);
    makeBanner(state, facts, size);
    makeCertificate(state, size);
    makeHelp(state, size);
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
