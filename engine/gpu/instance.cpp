// SPDX-License-Identifier: Apache-2.0
// Creating a VkInstance, receiving validation messages, and configuring drivers before they start.
#include "gpu/instance.hpp"

#include <cstdlib>
#include <cstring>

namespace restage::gpu {

namespace {

void set_default(const char* name, const std::string& value) {
#ifdef _WIN32
    if (!std::getenv(name)) _putenv_s(name, value.c_str());
#else
    setenv(name, value.c_str(), 0);
#endif
}

// Compiled kernels persist in a folder of our own, where other programs' shaders do not evict them.
// Read only by Mesa, when its drivers start. Once per process: setenv is not safe against getenv on
// other threads. LP_NATIVE_VECTOR_WIDTH is left to llvmpipe: 128 took as long to compile as 256 and ran
// arithmetic at half the speed.
void set_driver_defaults(const std::filesystem::path& cache_dir) {
    static std::once_flag once;
    std::call_once(once, [&] {
        if (cache_dir.empty() || std::getenv("MESA_SHADER_CACHE_DIR") || std::getenv("MESA_SHADER_CACHE_DISABLE"))
            return;
        std::error_code failed;
        std::filesystem::create_directories(cache_dir / "mesa", failed);
        if (!failed) set_default("MESA_SHADER_CACHE_DIR", (cache_dir / "mesa").string());
    });
}

// volk keeps the loader's functions in globals. What vkGetInstanceProcAddr returns for them are the loader's own
// entries, the same for every instance, so the first instance's serve all; a window's extensions are loaded separately.
void load_functions(VkInstance instance, bool again) {
    static std::mutex mutex;
    static bool loaded = false;
    std::lock_guard lock(mutex);
    if (loaded && !again) return;
    volkLoadInstanceOnly(instance);
    loaded = true;
}

template <class Function>
Function instance_function(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

} // namespace

bool has_extension(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    for (const VkExtensionProperties& extension : extensions)
        if (std::strcmp(extension.extensionName, name) == 0) return true;
    return false;
}

VKAPI_ATTR VkBool32 VKAPI_CALL Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                    VkDebugUtilsMessageTypeFlagsEXT,
                                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& self = *static_cast<Instance*>(user);
    // The loader reports drivers it cannot open; not our fault.
    if (data->pMessageIdName && std::strcmp(data->pMessageIdName, "Loader Message") == 0) return VK_FALSE;
    {
        std::lock_guard lock(self.mutex_);
        self.messages_.emplace_back(data->pMessage);
    }
    self.log_->write(severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? LogLevel::error : LogLevel::warning,
                     std::string("vulkan validation: ") + data->pMessage);
    return VK_FALSE;
}

Result<std::unique_ptr<Instance>> Instance::create(const InstanceOptions& options, Log& log, bool& no_driver) {
    no_driver = false;
    if (options.driver_defaults) set_driver_defaults(options.cache_dir);
    static const VkResult loader = volkInitialize();
    if (loader != VK_SUCCESS)
        return fail(
            "Vulkan is not installed: the loader library (libvulkan.so.1, vulkan-1.dll) was not found; "
            "install your distribution's Vulkan loader and a driver");

    const char* const layer = "VK_LAYER_KHRONOS_validation";
    std::uint32_t count = 0;
    std::vector<VkExtensionProperties> available;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    available.resize(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, available.data());
    available.resize(count);

    std::vector<const char*> extensions;
    for (const std::string& extension : options.extensions) {
        if (!has_extension(available, extension.c_str()))
            return fail("Vulkan: the instance extension " + extension + " is missing; update the graphics driver");
        extensions.push_back(extension.c_str());
    }
    VkInstanceCreateFlags flags = 0;
#ifdef VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME
    if (has_extension(available, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) { // MoltenVK and the like
        extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
        flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
    }
#endif

    auto self = std::unique_ptr<Instance>(new Instance);
    self->log_ = &log;
    const VkDebugUtilsMessengerCreateInfoEXT messenger{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = self.get()};
    const VkValidationFeatureEnableEXT enable = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                     .pNext = &messenger,
                                     .enabledValidationFeatureCount = 1,
                                     .pEnabledValidationFeatures = &enable};
    if (options.validation) {
        std::uint32_t layers = 0;
        vkEnumerateInstanceLayerProperties(&layers, nullptr);
        std::vector<VkLayerProperties> properties(layers);
        vkEnumerateInstanceLayerProperties(&layers, properties.data());
        bool found = false;
        for (const VkLayerProperties& p : properties)
            found |= std::strcmp(p.layerName, layer) == 0;
        if (!found)
            return fail("Vulkan validation was requested, but " + std::string(layer) +
                        " is not installed (Debian: vulkan-validationlayers)");
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME); // provided by the layer
        self->debug_utils_ = true;
    }

    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pApplicationName = "restage",
                                        .pEngineName = "restage",
                                        .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = options.validation ? &features : nullptr,
                                    .flags = flags,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = options.validation ? 1u : 0u,
                                    .ppEnabledLayerNames = &layer,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
    const VkResult result = vkCreateInstance(&info, nullptr, &self->handle_);
    if (result != VK_SUCCESS) {
        self->handle_ = VK_NULL_HANDLE;
        no_driver = result == VK_ERROR_INCOMPATIBLE_DRIVER;
        return fail(no_driver ? "no Vulkan driver is installed; install one for your graphics card, or Mesa's "
                                "lavapipe, which needs no graphics card (Debian: mesa-vulkan-drivers)"
                              : std::string("Vulkan could not be started: ") + result_name(result));
    }
    load_functions(self->handle_, !options.extensions.empty());
    if (options.validation) {
        auto create =
            instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(self->handle_, "vkCreateDebugUtilsMessengerEXT");
        if (!create || create(self->handle_, &messenger, nullptr, &self->messenger_) != VK_SUCCESS)
            return fail("Vulkan validation: the debug messenger could not be created");
    }
    return self;
}

Instance::~Instance() {
    if (!handle_) return;
    if (messenger_)
        instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(handle_, "vkDestroyDebugUtilsMessengerEXT")(
            handle_, messenger_, nullptr);
    vkDestroyInstance(handle_, nullptr);
}

Result<std::vector<VkPhysicalDevice>> Instance::physical_devices() const {
    std::uint32_t count = 0;
    VkResult result = vkEnumeratePhysicalDevices(handle_, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    if (result == VK_SUCCESS) result = vkEnumeratePhysicalDevices(handle_, &count, devices.data());
    if (result != VK_SUCCESS) return fail(std::string("listing Vulkan devices failed: ") + result_name(result));
    devices.resize(count);
    return devices;
}

std::vector<std::string> Instance::messages() const {
    std::lock_guard lock(mutex_);
    return messages_;
}

void Instance::clear_messages() {
    std::lock_guard lock(mutex_);
    messages_.clear();
}

} // namespace restage::gpu
