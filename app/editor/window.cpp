// SPDX-License-Identifier: Apache-2.0
#include "window.hpp"

#include "canvas.hpp"
#include "chords.hpp"
#include "damage.hpp"
#include "gpu/device.hpp"
#include "theme.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>
#include <imgui_internal.h>
#include <implot.h>
#include <algorithm>
#include <optional>

#if defined(__linux__)
#include <dlfcn.h>
#endif

// Part of Dear ImGui's backend, but missing from its header.
ImGuiKey ImGui_ImplGlfw_KeyToImGuiKey(int keycode, int scancode);

namespace restage::editor {

namespace {

// Errors that Dear ImGui's backend cannot return.
VkResult last_failure = VK_SUCCESS; // [main]
void note_failure(VkResult result) {
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR) last_failure = result;
}

std::string glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown reason";
}

} // namespace

struct Window::Impl {
    GLFWwindow* window = nullptr;
    std::unique_ptr<gpu::Device> device;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    ImGui_ImplVulkanH_Window swap;
    Canvas canvas;
    Damage damage;
    std::string layout_path;
    std::vector<std::filesystem::path> dropped;
    glm::vec2 dropped_at{0};
    std::vector<ImGuiKeyChord> keys;
    float scale = 1;
    bool imgui = false, imgui_glfw = false, imgui_vulkan = false;
    bool stale = false; // the swapchain no longer fits the window
    int settling = 0;   // frames that should follow soon

    ~Impl() {
        if (device) static_cast<void>(device->wait_idle());
        if (imgui_vulkan) ImGui_ImplVulkan_Shutdown();
        if (imgui_glfw) ImGui_ImplGlfw_Shutdown();
        if (imgui) {
            ImPlot::DestroyContext();
            ImGui::DestroyContext();
        }
        canvas = {};
        if (swap.Swapchain) ImGui_ImplVulkanH_DestroyWindow(device->instance(), device->handle(), &swap, nullptr);
        if (surface) vkDestroySurfaceKHR(device->instance(), surface, nullptr);
        device.reset();
        if (window) glfwDestroyWindow(window);
        glfwTerminate();
    }

    Result<void> resize() {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (width <= 0 || height <= 0) return {};
        if (stale || swap.Width != width || swap.Height != height) {
            ImGui_ImplVulkanH_CreateOrResizeWindow(device->instance(), device->physical_device(), device->handle(),
                                                   &swap, device->queue_family(), nullptr, width, height, 2,
                                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT);
            swap.FrameIndex = 0;
            stale = false;
            damage.forget();
            RESTAGE_TRY(canvas, Canvas::create(*device, swap.SurfaceFormat.format, std::uint32_t(swap.Width),
                                               std::uint32_t(swap.Height)));
        }
        return {};
    }

    // The part of the window that has to be drawn [pixel]; none if nothing changed.
    std::optional<VkRect2D> take_damage(ImDrawData& draw) {
        ImRect rect = damage.update(draw);
        const bool textures = draw.Textures && std::ranges::any_of(*draw.Textures, [](const ImTextureData* texture) {
                                  return texture->Status != ImTextureStatus_OK;
                              });
        const ImVec2 density = draw.FramebufferScale, corner = draw.DisplayPos;
        if (rect.Min.x >= rect.Max.x) {
            if (!textures) return {};
            rect = {corner, {corner.x + 1, corner.y + 1}}; // the backend has textures to free: one pixel is enough
        }
        Damage::clip(draw, rect);
        const int x0 = std::clamp(int((rect.Min.x - corner.x) * density.x), 0, swap.Width - 1),
                  y0 = std::clamp(int((rect.Min.y - corner.y) * density.y), 0, swap.Height - 1),
                  x1 = std::clamp(int((rect.Max.x - corner.x) * density.x), x0 + 1, swap.Width),
                  y1 = std::clamp(int((rect.Max.y - corner.y) * density.y), y0 + 1, swap.Height);
        return VkRect2D{{x0, y0}, {std::uint32_t(x1 - x0), std::uint32_t(y1 - y0)}};
    }

    Result<void> present(ImDrawData* draw) {
        const auto area = take_damage(*draw);
        if (!area) return {};
        auto& semaphores = swap.FrameSemaphores[static_cast<int>(swap.SemaphoreIndex)];
        VkResult result = vkAcquireNextImageKHR(device->handle(), swap.Swapchain, UINT64_MAX,
                                                semaphores.ImageAcquiredSemaphore, VK_NULL_HANDLE, &swap.FrameIndex);
        if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) stale = true;
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            damage.forget();
            return {};
        }
        if (result < 0) return device->error(result, "drawing the window");
        auto& frame = swap.Frames[static_cast<int>(swap.FrameIndex)];
        note_failure(vkWaitForFences(device->handle(), 1, &frame.Fence, VK_TRUE, UINT64_MAX));
        note_failure(vkResetFences(device->handle(), 1, &frame.Fence));
        note_failure(vkResetCommandPool(device->handle(), frame.CommandPool, 0));
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        note_failure(vkBeginCommandBuffer(frame.CommandBuffer, &begin));
        canvas.begin(frame.CommandBuffer, *area);
        ImGui_ImplVulkan_RenderDrawData(draw, frame.CommandBuffer);
        canvas.end(frame.CommandBuffer);
        canvas.copy_to(frame.CommandBuffer, frame.Backbuffer);
        note_failure(vkEndCommandBuffer(frame.CommandBuffer));
        const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
        const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .waitSemaphoreCount = 1,
                                  .pWaitSemaphores = &semaphores.ImageAcquiredSemaphore,
                                  .pWaitDstStageMask = &stage,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &frame.CommandBuffer,
                                  .signalSemaphoreCount = 1,
                                  .pSignalSemaphores = &semaphores.RenderCompleteSemaphore};
        note_failure(vkQueueSubmit(device->queue(), 1, &submit, frame.Fence));
        const VkPresentInfoKHR present{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                       .waitSemaphoreCount = 1,
                                       .pWaitSemaphores = &semaphores.RenderCompleteSemaphore,
                                       .swapchainCount = 1,
                                       .pSwapchains = &swap.Swapchain,
                                       .pImageIndices = &swap.FrameIndex};
        result = vkQueuePresentKHR(device->queue(), &present);
        if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
            stale = true;
        else
            note_failure(result);
        swap.SemaphoreIndex = (swap.SemaphoreIndex + 1) % swap.SemaphoreCount;
        if (last_failure != VK_SUCCESS)
            return device->error(std::exchange(last_failure, VK_SUCCESS), "drawing the window");
        return {};
    }
};

Window::Window(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Window::~Window() = default;

Result<std::unique_ptr<Window>> Window::create(const WindowOptions& options, Log& log) {
    if (!glfwInit())
        return fail("the window cannot be opened: " + glfw_error() +
                    "; without a display use the commands (`restage --help`)");
    auto impl = std::make_unique<Impl>(); // from here on its destructor cleans up
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    impl->window = glfwCreateWindow(options.size.x, options.size.y, options.title.c_str(), nullptr, nullptr);
    if (!impl->window) return fail("the window cannot be opened: " + glfw_error());
    glfwSetWindowSizeLimits(impl->window, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(impl->window, impl.get());
    glfwSetDropCallback(impl->window, [](GLFWwindow* window, int count, const char** paths) {
        auto& self = *static_cast<Impl*>(glfwGetWindowUserPointer(window));
        double x = 0, y = 0;
        glfwGetCursorPos(window, &x, &y);
        self.dropped_at = {float(x), float(y)};
        for (int i = 0; i < count; ++i)
            self.dropped.emplace_back(paths[i]);
    });

    // An exposed window must be shown again.
    glfwSetWindowRefreshCallback(impl->window, [](GLFWwindow* window) {
        static_cast<Impl*>(glfwGetWindowUserPointer(window))->damage.forget();
    });
    // Dear ImGui's own callback, set later, calls this one.
    glfwSetKeyCallback(impl->window, [](GLFWwindow* window, int key, int scancode, int action, int mods) {
        if (action != GLFW_PRESS) return;
        auto& self = *static_cast<Impl*>(glfwGetWindowUserPointer(window));
        ImGuiKeyChord chord = ImGui_ImplGlfw_KeyToImGuiKey(key, scancode);
        if (chord == ImGuiKey_None) return;
        if (mods & GLFW_MOD_CONTROL) chord |= ImGuiMod_Ctrl;
        if (mods & GLFW_MOD_SHIFT) chord |= ImGuiMod_Shift;
        if (mods & GLFW_MOD_ALT) chord |= ImGuiMod_Alt;
        if (mods & GLFW_MOD_SUPER) chord |= ImGuiMod_Super;
        self.keys.push_back(chord);
    });

    gpu::DeviceOptions device_options{.select = options.device, .validation = options.validation};
    std::uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions) return fail("this display cannot show Vulkan: " + glfw_error());
    device_options.instance_extensions.assign(extensions, extensions + count);
    device_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    RESTAGE_TRY(impl->device, gpu::Device::create(device_options, log));
    gpu::Device& device = *impl->device;
    // Dear ImGui's backend calls volk's globals; all other code has a table, so they can be this device's.
    volkLoadDevice(device.handle());

    if (const VkResult result = glfwCreateWindowSurface(device.instance(), impl->window, nullptr, &impl->surface);
        result != VK_SUCCESS)
        return device.error(result, "opening the window");
    VkBool32 presents = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(device.physical_device(), device.queue_family(), impl->surface, &presents);
    if (!presents) return fail(device.info().name + " cannot show pictures on this display; try another --device");
    impl->swap.Surface = impl->surface;
    const VkFormat formats[] = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};
    impl->swap.SurfaceFormat = ImGui_ImplVulkanH_SelectSurfaceFormat(device.physical_device(), impl->surface, formats,
                                                                     2, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR);
    // MAILBOX does not wait for the screen, so a queued frame never delays input; FIFO is always supported.
    const VkPresentModeKHR modes[] = {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_FIFO_KHR};
    impl->swap.PresentMode = ImGui_ImplVulkanH_SelectPresentMode(device.physical_device(), impl->surface, modes, 2);
    RESTAGE_CHECK(impl->resize());

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImPlot::CreateContext();
    impl->imgui = true;
    ImGuiIO& io = ImGui::GetIO();
    io.ConfigFlags |= ImGuiConfigFlags_DockingEnable; // keys serve the editor's shortcuts, not menu navigation
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.MouseDoubleClickTime = 0.5f; // the usual desktop value; 0.3 s loses clicks when frames are slow
    io.MouseSingleClickDelay = 0.6f;
    float monitor_scale = 1;
    glfwGetWindowContentScale(impl->window, &monitor_scale, nullptr);
    impl->scale = options.scale > 0 ? options.scale : std::max(1.f, monitor_scale);
    apply_theme(impl->scale, options.fonts, find_fallback_fonts(system_font_folders()).fonts);
    // Sizes in it are pixels: each scale has its own.
    if (!options.layout.empty())
        impl->layout_path = (options.layout / fmt::format("layout-{:.0f}.ini", impl->scale * 100)).string();
    io.IniFilename = impl->layout_path.empty() ? nullptr : impl->layout_path.c_str();

    impl->imgui_glfw = ImGui_ImplGlfw_InitForVulkan(impl->window, true);
    ImGui_ImplVulkan_InitInfo init{};
    init.ApiVersion = VK_API_VERSION_1_3;
    init.Instance = device.instance();
    init.PhysicalDevice = device.physical_device();
    init.Device = device.handle();
    init.QueueFamily = device.queue_family();
    init.Queue = device.queue();
    init.DescriptorPoolSize = 1024; // textures: fonts, pictures, thumbnails
    init.MinImageCount = 2;
    init.ImageCount = std::max(2u, impl->swap.ImageCount);
    init.PipelineCache = device.pipeline_cache();
    init.PipelineInfoMain.RenderPass = impl->canvas.render_pass();
    init.PipelineInfoMain.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    init.CheckVkResultFn = note_failure;
    init.MinAllocationSize = 1024 * 1024;
    impl->imgui_vulkan = ImGui_ImplVulkan_Init(&init);
    if (!impl->imgui_vulkan) return fail("the window cannot be drawn: Dear ImGui's Vulkan backend did not start");
    return std::unique_ptr<Window>(new Window(std::move(impl)));
}

void Window::wait(double seconds) { glfwWaitEventsTimeout(std::max(seconds, 1e-3)); }
void Window::wake() { glfwPostEmptyEvent(); }

Result<bool> Window::begin_frame() {
    RESTAGE_CHECK(impl_->resize());
    if (glfwGetWindowAttrib(impl_->window, GLFW_ICONIFIED)) return false;
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    begin_imgui_frame();
    return true;
}

Result<void> Window::end_frame() {
    // Dear ImGui spreads simultaneous events (a press and its release) over frames, and a popup opened by a click
    // settles its size and place in the next frames.
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    const bool input = !context.InputEventsQueue.empty() || !context.InputEventsTrail.empty();
    impl_->settling = input ? 3 : std::max(impl_->settling - 1, 0);
    ImGui::Render();
    return impl_->present(ImGui::GetDrawData());
}

bool Window::unsettled() const { return impl_->settling > 0; }

std::vector<ImGuiKeyChord> Window::take_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (std::any_of(std::begin(io.MouseClicked), std::end(io.MouseClicked), [](bool clicked) { return clicked; }))
        return {};
    for (const ImGuiInputEvent& event : ImGui::GetCurrentContext()->InputEventsQueue)
        if (event.Type == ImGuiInputEventType_MouseButton) return {};
    return std::exchange(impl_->keys, {});
}

bool Window::input_waits() const {
    return !impl_->keys.empty() || ImGui::GetCurrentContext()->InputEventsQueue.Size > 0;
}

bool Window::close_requested() const { return glfwWindowShouldClose(impl_->window); }
bool Window::display_gone() const {
#if defined(__linux__)
    // Both looked up by name: a GLFW without Wayland lacks the function.
    using Get = void* (*)();
    using Error = int (*)(void*);
    static const auto get = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "glfwGetWaylandDisplay"));
    void* display = get ? get() : nullptr;
    if (!display) return false;
    void* library = dlopen("libwayland-client.so.0", RTLD_LAZY | RTLD_NOLOAD);
    if (!library) return false;
    const auto error = reinterpret_cast<Error>(dlsym(library, "wl_display_get_error"));
    const bool gone = error && error(display) != 0;
    dlclose(library);
    return gone;
#else
    return false;
#endif
}
void Window::refuse_close() { glfwSetWindowShouldClose(impl_->window, GLFW_FALSE); }

std::vector<std::filesystem::path> Window::take_dropped(glm::vec2& where) {
    where = impl_->dropped_at;
    return std::exchange(impl_->dropped, {});
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(impl_->window, title.c_str()); }
float Window::scale() const { return impl_->scale; }
GLFWwindow* Window::handle() const { return impl_->window; }

} // namespace restage::editor
