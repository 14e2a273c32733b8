#include "view/ui.h"

#include <algorithm>
#include <unistd.h>

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include "view/keys.h"

namespace relief {
namespace {

void checkResult(VkResult result) { checkVulkan(result, "Dear ImGui's call of Vulkan"); }

/// The font of the panels, and last the one of tables: DejaVu Sans, proportional and monospaced, where it is installed,
/// else the built-in one, which is monospaced.
void loadFonts() {
    for (const char* name : {"DejaVuSans", "DejaVuSansMono"}) {
        const std::string path = fmt::format("/usr/share/fonts/truetype/dejavu/{}.ttf", name);
        ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
        if (access(path.c_str(), R_OK) == 0)
            fonts.AddFontFromFileTTF(path.c_str(), 14);
        else
            fonts.AddFontDefault();
    }
}

void setStyle() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 6;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
    style.WindowBorderSize = 0;
    style.FramePadding = {7, 4};
    style.ItemSpacing = {8, 6};
    style.WindowPadding = {12, 12};
    style.ScrollbarSize = 10;
    // Dark slate over the picture, with one warm accent.
    const ImVec4 slate(0.11f, 0.12f, 0.14f, 0.88f), list(0.11f, 0.12f, 0.14f, 0.98f);
    const ImVec4 raised(0.20f, 0.22f, 0.25f, 1), accent(0.86f, 0.56f, 0.26f, 1);
    const ImVec4 hovered(0.27f, 0.29f, 0.33f, 1), warm(0.45f, 0.34f, 0.22f, 1);
    const std::pair<int, ImVec4> colors[] = {
        {ImGuiCol_WindowBg, slate},        {ImGuiCol_PopupBg, list},           {ImGuiCol_FrameBg, raised},
        {ImGuiCol_Button, raised},         {ImGuiCol_Header, raised},          {ImGuiCol_TitleBgActive, slate},
        {ImGuiCol_TitleBg, slate},         {ImGuiCol_FrameBgHovered, hovered}, {ImGuiCol_ButtonHovered, hovered},
        {ImGuiCol_HeaderHovered, hovered}, {ImGuiCol_FrameBgActive, warm},     {ImGuiCol_ButtonActive, warm},
        {ImGuiCol_HeaderActive, warm},     {ImGuiCol_SliderGrab, accent},      {ImGuiCol_SliderGrabActive, accent},
        {ImGuiCol_CheckMark, accent},      {ImGuiCol_PlotHistogram, accent},   {ImGuiCol_TextSelectedBg, warm}};
    for (const auto& [index, color] : colors) style.Colors[index] = color;
}

/// Keys of text fields have the numbers that kKeys gives them.
void mapKeys() {
    ImGuiIO& io = ImGui::GetIO();
    const std::pair<int, int> keys[] = {
        {ImGuiKey_Tab, GLFW_KEY_TAB},          {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
        {ImGuiKey_RightArrow, GLFW_KEY_RIGHT}, {ImGuiKey_Home, GLFW_KEY_HOME},
        {ImGuiKey_End, GLFW_KEY_END},          {ImGuiKey_Delete, GLFW_KEY_DELETE},
        {ImGuiKey_Enter, GLFW_KEY_ENTER},      {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
        {ImGuiKey_Space, GLFW_KEY_SPACE},      {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE}};
    for (const auto& [own, key] : keys) io.KeyMap[own] = key;
}

} // namespace

Ui::Ui(Device& device, const Swapchain& swapchain) : device_(device) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;              // every window starts the same
    io.ConfigInputTextCursorBlink = false; // else a field would never be at rest
    mapKeys();
    loadFonts();
    setStyle();

    // Its own descriptors, pipeline and fonts on the device.
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 4;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    checkVulkan(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_), "vkCreateDescriptorPool");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance();
    info.PhysicalDevice = device.physical();
    info.Device = device.handle();
    info.QueueFamily = device.queueFamily();
    info.Queue = device.queue();
    info.DescriptorPool = pool_;
    info.MinImageCount = 2;
    info.ImageCount = std::max(swapchain.imageCount(), 2u);
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = checkResult;
    ImGui_ImplVulkan_Init(&info, swapchain.renderPass());
    device.submitAndWait([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Ui::~Ui() {
    vkDeviceWaitIdle(device_.handle());
    ImGui_ImplVulkan_Shutdown();
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
    ImGui::DestroyContext();
}

bool Ui::take(const Event& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.kind) {
    case EventKind::move: io.MousePos = {float(event.at.x), float(event.at.y)}; return false;
    case EventKind::press: io.MouseDown[int(event.button)] = true; return io.WantCaptureMouse;
    case EventKind::release: io.MouseDown[int(event.button)] = false; return false;
    case EventKind::wheel:
        if (!io.WantCaptureMouse) return false;
        io.MouseWheel += float(event.at.x);
        return true;
    case EventKind::key:
        if (!io.WantTextInput) return false;
        io.KeysDown[event.key] = true;
        released_.push_back(event.key);
        return true;
    case EventKind::text:
        if (!io.WantTextInput) return false;
        io.AddInputCharactersUTF8(event.text.c_str());
        return true;
    default: return false;
    }
}

void Ui::begin(std::uint32_t width, std::uint32_t height, double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(width), float(height)};
    io.DeltaTime = float(std::clamp(seconds, 1e-3, 1.0));
    ImGui_ImplVulkan_NewFrame();
    ImGui::NewFrame();
}

void Ui::end() {
    ImGui::Render();
    for (const int key : std::exchange(released_, {})) ImGui::GetIO().KeysDown[key] = false;
}

void Ui::draw(VkCommandBuffer commands) { ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands); }

bool Ui::wantsText() const { return ImGui::GetIO().WantTextInput; }
bool Ui::isDragging() const { return ImGui::IsAnyItemActive(); }

} // namespace relief
