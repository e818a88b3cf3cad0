// A C++ program that owns its Vulkan device and lends it: host SHADER.spv OUTPUT. Frames are left in an image, which its own compute shader reads, in an image of
// half floats and in a buffer; semaphores stand between the two. It loads Vulkan by itself, for itself alone, and counts whether anybody else does.

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include <dlfcn.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "irradia.h"

namespace {

constexpr uint32_t WIDTH = 64, HEIGHT = 48;

void check(bool condition, const char *what, int line) {
    if (!condition) {
        std::fprintf(stderr, "line %d: %s; last error: %s\n", line, what, irradia_last_error());
        std::exit(1);
    }
}
#define CHECK(condition) check((condition), #condition, __LINE__)
#define OK(call) CHECK((call) == IRRADIA_OK)
#define VK(call) CHECK((call) == VK_SUCCESS)

std::atomic<int> messages{0};
std::atomic<int> loaded{0};
std::atomic<bool> counting{false};

VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT *data, void *) {
    // An output without an attachment is discarded; src/vulkan/messages.rs leaves these out too.
    if (std::strstr(data->pMessage, "VK_FORMAT_UNDEFINED` does not match fragment shader output") ||
        std::strstr(data->pMessage, "writes to output Location")) {
        return VK_FALSE;
    }
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++messages;
    return VK_FALSE;
}

PFN_vkGetInstanceProcAddr get_instance_proc_addr;
VkInstance instance;
VkPhysicalDevice physical;
VkDevice device;
VkQueue queue;
uint32_t family;
std::mutex queue_mutex;
std::atomic<int> turns{0};

void lock_queue(void *) {
    queue_mutex.lock();
    ++turns;
}
void unlock_queue(void *) { queue_mutex.unlock(); }

template <class Function> Function global(const char *name) {
    return reinterpret_cast<Function>(get_instance_proc_addr(nullptr, name));
}
template <class Function> Function function(const char *name) {
    auto found = reinterpret_cast<Function>(get_instance_proc_addr(instance, name));
    check(found != nullptr, name, 0);
    return found;
}
#define CALL(name) function<PFN_##name>(#name)

VkDebugUtilsMessengerEXT messenger;

void open_instance() {
    // RTLD_LOCAL: no name of the loader's is seen by anybody else.
    void *loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    CHECK(loader != nullptr);
    get_instance_proc_addr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
    CHECK(get_instance_proc_addr != nullptr);
    const bool validated = std::getenv("HOST_VALIDATION") != nullptr;
    const char *layer = "VK_LAYER_KHRONOS_validation";
    const char *extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &enabled;
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validated) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    VK(global<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &instance));
    if (validated) {
        VkDebugUtilsMessengerCreateInfoEXT wanted{};
        wanted.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
        wanted.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        wanted.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        wanted.pfnUserCallback = hear;
        VK(CALL(vkCreateDebugUtilsMessengerEXT)(instance, &wanted, nullptr, &messenger));
    }
    uint32_t count = 1;
    CALL(vkEnumeratePhysicalDevices)(instance, &count, &physical);
    CHECK(count == 1);
}

irradia_instance_descriptor described_instance() {
    irradia_instance_descriptor described{};
    described.size = sizeof described;
    described.get_instance_proc_addr = reinterpret_cast<irradia_void_function>(get_instance_proc_addr);
    described.instance = instance;
    described.physical_device = physical;
    described.api_version = VK_API_VERSION_1_3;
    return described;
}

void open_device(const void *features) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queues{};
    queues.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queues.queueFamilyIndex = family;
    queues.queueCount = 1;
    queues.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queues;
    VK(CALL(vkCreateDevice)(physical, &info, nullptr, &device));
    CALL(vkGetDeviceQueue)(device, family, 0, &queue);
}

VkDeviceMemory memory_for(const VkMemoryRequirements &needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties properties;
    CALL(vkGetPhysicalDeviceMemoryProperties)(physical, &properties);
    for (uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
        const bool has = (properties.memoryTypes[type].propertyFlags & wanted) == wanted;
        if ((needs.memoryTypeBits >> type & 1) && has) {
            VkMemoryAllocateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
            info.allocationSize = needs.size;
            info.memoryTypeIndex = type;
            VkDeviceMemory memory;
            VK(CALL(vkAllocateMemory)(device, &info, nullptr, &memory));
            return memory;
        }
    }
    CHECK(!"a memory type");
    return VK_NULL_HANDLE;
}

struct Image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;

    Image(VkFormat format, VkImageUsageFlags usage) {
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {WIDTH, HEIGHT, 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = usage;
        VK(CALL(vkCreateImage)(device, &info, nullptr, &image));
        VkMemoryRequirements needs;
        CALL(vkGetImageMemoryRequirements)(device, image, &needs);
        memory = memory_for(needs, 0);
        VK(CALL(vkBindImageMemory)(device, image, memory, 0));
        VkImageViewCreateInfo seen{};
        seen.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        seen.image = image;
        seen.viewType = VK_IMAGE_VIEW_TYPE_2D;
        seen.format = format;
        seen.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VK(CALL(vkCreateImageView)(device, &seen, nullptr, &view));
    }
    ~Image() {
        CALL(vkDestroyImageView)(device, view, nullptr);
        CALL(vkDestroyImage)(device, image, nullptr);
        CALL(vkFreeMemory)(device, memory, nullptr);
    }
};

struct Buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped;

    Buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = size;
        info.usage = usage;
        VK(CALL(vkCreateBuffer)(device, &info, nullptr, &buffer));
        VkMemoryRequirements needs;
        CALL(vkGetBufferMemoryRequirements)(device, buffer, &needs);
        memory = memory_for(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        VK(CALL(vkBindBufferMemory)(device, buffer, memory, 0));
        VK(CALL(vkMapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    }
    ~Buffer() {
        CALL(vkDestroyBuffer)(device, buffer, nullptr);
        CALL(vkFreeMemory)(device, memory, nullptr);
    }
};

// Reads the image into the buffer by a compute shader, and the image of half floats by a copy, after `value` of the semaphore.
void read_images(const char *path, const Image &image, const Buffer &doubled, const Image &half, const Buffer &halves,
                 VkSemaphore semaphore, uint64_t value) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> code{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    VkShaderModuleCreateInfo shader_info{};
    shader_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    shader_info.codeSize = code.size();
    shader_info.pCode = reinterpret_cast<const uint32_t *>(code.data());
    VkShaderModule shader;
    VK(CALL(vkCreateShaderModule)(device, &shader_info, nullptr, &shader));
    VkDescriptorSetLayoutBinding bindings[2]{};
    bindings[0] = {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    bindings[1] = {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = 2;
    set_info.pBindings = bindings;
    VkDescriptorSetLayout set_layout;
    VK(CALL(vkCreateDescriptorSetLayout)(device, &set_info, nullptr, &set_layout));
    VkPipelineLayoutCreateInfo layout_info{};
    layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    VkPipelineLayout layout;
    VK(CALL(vkCreatePipelineLayout)(device, &layout_info, nullptr, &layout));
    VkComputePipelineCreateInfo pipeline_info{};
    pipeline_info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    pipeline_info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    pipeline_info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    pipeline_info.stage.module = shader;
    pipeline_info.stage.pName = "main";
    pipeline_info.layout = layout;
    VkPipeline pipeline;
    VK(CALL(vkCreateComputePipelines)(device, VK_NULL_HANDLE, 1, &pipeline_info, nullptr, &pipeline));
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = 2;
    pool_info.pPoolSizes = sizes;
    VkDescriptorPool pool;
    VK(CALL(vkCreateDescriptorPool)(device, &pool_info, nullptr, &pool));
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout;
    VkDescriptorSet set;
    VK(CALL(vkAllocateDescriptorSets)(device, &allocate, &set));
    const VkDescriptorImageInfo image_info{VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo buffer_info{doubled.buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet writes[2]{};
    for (uint32_t binding = 0; binding < 2; ++binding) {
        writes[binding].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[binding].dstSet = set;
        writes[binding].dstBinding = binding;
        writes[binding].descriptorCount = 1;
        writes[binding].descriptorType = bindings[binding].descriptorType;
    }
    writes[0].pImageInfo = &image_info;
    writes[1].pBufferInfo = &buffer_info;
    CALL(vkUpdateDescriptorSets)(device, 2, writes, 0, nullptr);

    VkCommandPoolCreateInfo commands_info{};
    commands_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    commands_info.queueFamilyIndex = family;
    VkCommandPool commands_pool;
    VK(CALL(vkCreateCommandPool)(device, &commands_info, nullptr, &commands_pool));
    VkCommandBufferAllocateInfo buffer_wanted{};
    buffer_wanted.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer_wanted.commandPool = commands_pool;
    buffer_wanted.commandBufferCount = 1;
    VkCommandBuffer commands;
    VK(CALL(vkAllocateCommandBuffers)(device, &buffer_wanted, &commands));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VK(CALL(vkBeginCommandBuffer)(commands, &begin));
    CALL(vkCmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    CALL(vkCmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    CALL(vkCmdDispatch)(commands, (WIDTH + 7) / 8, (HEIGHT + 7) / 8, 1);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {WIDTH, HEIGHT, 1};
    CALL(vkCmdCopyImageToBuffer)(commands, half.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, halves.buffer, 1, &region);
    VkMemoryBarrier to_host{};
    to_host.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    to_host.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    CALL(vkCmdPipelineBarrier)(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                               VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr, 0, nullptr);
    VK(CALL(vkEndCommandBuffer)(commands));
    VkTimelineSemaphoreSubmitInfo timeline{};
    timeline.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
    timeline.waitSemaphoreValueCount = 1;
    timeline.pWaitSemaphoreValues = &value;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.pNext = &timeline;
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &semaphore;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    {
        const std::lock_guard<std::mutex> guard(queue_mutex);
        VK(CALL(vkQueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE));
        VK(CALL(vkQueueWaitIdle)(queue));
    }
    CALL(vkDestroyCommandPool)(device, commands_pool, nullptr);
    CALL(vkDestroyDescriptorPool)(device, pool, nullptr);
    CALL(vkDestroyPipeline)(device, pipeline, nullptr);
    CALL(vkDestroyPipelineLayout)(device, layout, nullptr);
    CALL(vkDestroyDescriptorSetLayout)(device, set_layout, nullptr);
    CALL(vkDestroyShaderModule)(device, shader, nullptr);
}

// Vulkan without one of its functions.
std::string left_out;

PFN_vkVoidFunction VKAPI_CALL fewer_device_functions(VkDevice of, const char *name) {
    return left_out == name ? nullptr : CALL(vkGetDeviceProcAddr)(of, name);
}

PFN_vkVoidFunction VKAPI_CALL fewer_functions(VkInstance of, const char *name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(fewer_device_functions);
    }
    return left_out == name ? nullptr : get_instance_proc_addr(of, name);
}

irradia_device_descriptor described_device(const irradia_instance_descriptor &on, const void *features) {
    irradia_device_descriptor described{};
    described.size = sizeof described;
    described.instance = &on;
    described.device = device;
    described.queue = queue;
    described.queue_family = family;
    described.debug_utils = messenger != VK_NULL_HANDLE;
    described.features = features;
    described.lock_queue = lock_queue;
    described.unlock_queue = unlock_queue;
    return described;
}

irradia_context *context_on(const irradia_device_descriptor &lent) {
    irradia_context_descriptor wanted{};
    wanted.size = sizeof wanted;
    wanted.host_device = &lent;
    irradia_context *context = nullptr;
    OK(irradia_context_create(&wanted, &context));
    return context;
}

std::vector<float> copied(irradia_context *context) {
    irradia_scene *scene = nullptr;
    irradia_renderer *renderer = nullptr;
    irradia_frame *frame = nullptr;
    OK(irradia_scene_open(context, "cornell-point", nullptr, &scene));
    OK(irradia_renderer_create(context, nullptr, &renderer));
    irradia_frame_descriptor wanted{};
    wanted.size = sizeof wanted;
    wanted.width = WIDTH;
    wanted.height = HEIGHT;
    OK(irradia_render(renderer, scene, &wanted, &frame));
    std::vector<float> pixels(3 * WIDTH * HEIGHT);
    irradia_pixels_descriptor target{};
    target.size = sizeof target;
    target.slot = IRRADIA_SLOT_IMAGE;
    target.pixels = pixels.data();
    target.byte_count = sizeof(float) * pixels.size();
    OK(irradia_frame_copy(frame, &target));
    irradia_frame_destroy(frame);
    irradia_renderer_destroy(renderer);
    irradia_scene_destroy(scene);
    return pixels;
}

float half_to_float(uint16_t half) {
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    return exponent == 0 ? std::ldexp(float(mantissa), -24) : std::ldexp(float(mantissa + 1024), exponent - 25);
}

void show(const char *shader, const char *output, const irradia_device_descriptor &lent) {
    irradia_context *context = context_on(lent);
    irradia_scene *scene = nullptr;
    irradia_renderer *renderer = nullptr;
    irradia_frame *frame = nullptr;
    OK(irradia_scene_open(context, "cornell-point", nullptr, &scene));
    OK(irradia_renderer_create(context, nullptr, &renderer));

    const Image image(VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    const VkImageUsageFlags copied_twice = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT;
    const Image half(VK_FORMAT_R16G16B16A16_SFLOAT, copied_twice);
    const VkBufferUsageFlags target_usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const Buffer filled(16 + 16 * (WIDTH + 8) * HEIGHT, target_usage), caustics(16 * WIDTH * HEIGHT, target_usage);
    const Buffer doubled(16 * WIDTH * HEIGHT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT), halves(8 * WIDTH * HEIGHT, target_usage);
    VkSemaphoreTypeCreateInfo type{};
    type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    type.initialValue = 3;
    VkSemaphoreCreateInfo semaphore_info{};
    semaphore_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    semaphore_info.pNext = &type;
    VkSemaphore semaphore;
    VK(CALL(vkCreateSemaphore)(device, &semaphore_info, nullptr, &semaphore));

    irradia_target_descriptor targets[4]{};
    for (auto &target : targets) {
        target.size = sizeof target;
        target.slot = IRRADIA_SLOT_IMAGE;
        target.before.family = target.after.family = IRRADIA_FAMILY_SAME;
        target.after.stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        target.after.access = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT;
    }
    targets[0].resource = reinterpret_cast<uint64_t>(image.image);
    targets[0].format = VK_FORMAT_R32G32B32A32_SFLOAT;
    targets[0].after.layout = VK_IMAGE_LAYOUT_GENERAL;
    targets[1].resource = reinterpret_cast<uint64_t>(half.image);
    targets[1].format = VK_FORMAT_R16G16B16A16_SFLOAT;
    targets[1].slot = IRRADIA_SLOT_DIRECT;
    targets[1].after.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    targets[2].resource = reinterpret_cast<uint64_t>(filled.buffer);
    targets[2].is_buffer = 1;
    targets[2].row_pixels = WIDTH + 8;
    targets[2].offset = 16;
    targets[2].after.stages = VK_PIPELINE_STAGE_2_HOST_BIT;
    targets[2].after.access = VK_ACCESS_2_HOST_READ_BIT;
    targets[3] = targets[2];
    targets[3].resource = reinterpret_cast<uint64_t>(caustics.buffer);
    targets[3].slot = IRRADIA_SLOT_SPECULAR; // which nothing fills
    targets[3].row_pixels = 0;
    targets[3].offset = 0;
    std::memset(caustics.mapped, 0x7f, 16 * WIDTH * HEIGHT);
    const irradia_semaphore_point wait{reinterpret_cast<uint64_t>(semaphore), 3};
    const irradia_semaphore_point signal{reinterpret_cast<uint64_t>(semaphore), 5};
    irradia_frame_descriptor wanted{};
    wanted.size = sizeof wanted;
    wanted.width = WIDTH;
    wanted.height = HEIGHT;
    wanted.stay_on_device = 1;
    wanted.targets = targets;
    wanted.target_count = 4;
    wanted.waits = &wait;
    wanted.wait_count = 1;
    wanted.signals = &signal;
    wanted.signal_count = 1;
    OK(irradia_render(renderer, scene, &wanted, &frame));
    uint64_t reached = 0;
    VK(CALL(vkGetSemaphoreCounterValue)(device, semaphore, &reached));
    CHECK(reached == 5);
    irradia_pixels_descriptor nothing{};
    nothing.size = sizeof nothing;
    nothing.slot = IRRADIA_SLOT_IMAGE;
    CHECK(irradia_frame_copy(frame, &nothing) == IRRADIA_ERROR_ARGUMENT);
    irradia_frame_destroy(frame);
    read_images(shader, image, doubled, half, halves, semaphore, 5);

    // A point that nobody signals is an error after a while, and the next frame is none the worse for it.
    const irradia_semaphore_point never{reinterpret_cast<uint64_t>(semaphore), 99};
    wanted.waits = &never;
    wanted.patience = 0.01f;
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_DEVICE);
    wanted.wait_count = wanted.signal_count = 0;
    for (const VkFormat format : {VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_D32_SFLOAT, VK_FORMAT_BC1_RGB_UNORM_BLOCK}) {
        targets[1].format = format;
        CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_DEVICE);
    }
    targets[1].format = VK_FORMAT_R16G16B16A16_SFLOAT;
    targets[0].before = targets[0].after;
    targets[1].before = targets[1].after;
    OK(irradia_render(renderer, scene, &wanted, &frame));
    irradia_frame_destroy(frame);

    const std::vector<float> expected = copied(context);
    const auto *twice = static_cast<const float *>(doubled.mapped);
    const auto *lines = reinterpret_cast<const float *>(static_cast<const char *>(filled.mapped) + 16);
    const auto *small = static_cast<const uint16_t *>(halves.mapped);
    double direct = 0;
    std::vector<float> seen;
    for (uint32_t y = 0; y < HEIGHT; ++y) {
        for (uint32_t x = 0; x < WIDTH; ++x) {
            for (uint32_t channel = 0; channel < 3; ++channel) {
                const float value = expected[3 * (y * WIDTH + x) + channel];
                CHECK(twice[4 * (y * WIDTH + x) + channel] == 2 * value);
                CHECK(lines[4 * (y * (WIDTH + 8) + x) + channel] == value);
                CHECK(static_cast<const float *>(caustics.mapped)[4 * (y * WIDTH + x) + channel] == 0);
                direct += half_to_float(small[4 * (y * WIDTH + x) + channel]);
                seen.push_back(twice[4 * (y * WIDTH + x) + channel] / 2);
            }
        }
    }
    CHECK(direct > 0 && std::isfinite(direct));
    std::ofstream(output, std::ios::binary)
        .write(reinterpret_cast<const char *>(seen.data()), static_cast<std::streamsize>(seen.size() * sizeof(float)));
    irradia_renderer_destroy(renderer);
    irradia_scene_destroy(scene);
    irradia_context_destroy(context);
    CALL(vkDestroySemaphore)(device, semaphore, nullptr);
}

} // namespace

// Interposes the system's, for libraries too.
extern "C" void *dlopen(const char *name, int flags) {
    static const auto system = reinterpret_cast<void *(*)(const char *, int)>(dlsym(RTLD_NEXT, "dlopen"));
    if (counting && name != nullptr && std::strstr(name, "vulkan") != nullptr) {
        ++loaded;
    }
    return system(name, flags);
}

int main(int count, char **arguments) {
    CHECK(count == 3);
    open_instance();
    counting = true;
    const irradia_instance_descriptor on = described_instance();
    irradia_requirements *requirements = nullptr;
    OK(irradia_requirements_create(&on, &requirements));
    irradia_requirements_descriptor needs{};
    needs.size = sizeof needs;
    OK(irradia_requirements_get(requirements, &needs));
    CHECK(needs.extension_count == 0 && needs.api_version == VK_API_VERSION_1_3);
    family = needs.queue_family;
    counting = false;
    open_device(needs.features);
    counting = true;

    // What cannot be used is said, before anything is done with it.
    irradia_device_descriptor lent = described_device(on, nullptr);
    irradia_context_descriptor wanted{};
    wanted.size = sizeof wanted;
    wanted.host_device = &lent;
    irradia_context *context = nullptr;
    CHECK(irradia_context_create(&wanted, &context) == IRRADIA_ERROR_DEVICE);
    CHECK(std::string(irradia_last_error()).find("synchronization2") != std::string::npos);
    lent.features = needs.features;
    lent.queue_family = 77;
    CHECK(irradia_context_create(&wanted, &context) == IRRADIA_ERROR_DEVICE);
    lent.queue_family = family;
    lent.unlock_queue = nullptr;
    CHECK(irradia_context_create(&wanted, &context) == IRRADIA_ERROR_ARGUMENT);
    lent.unlock_queue = unlock_queue;
    wanted.device = "0";
    CHECK(irradia_context_create(&wanted, &context) == IRRADIA_ERROR_ARGUMENT);
    wanted.device = nullptr;
    irradia_instance_descriptor fewer = on;
    fewer.get_instance_proc_addr = reinterpret_cast<irradia_void_function>(fewer_functions);
    lent.instance = &fewer;
    lent.debug_utils = 1;
    for (const char *name : {"vkGetPhysicalDeviceProperties2", "vkCmdDispatch", "vkSetDebugUtilsObjectNameEXT"}) {
        left_out = name;
        CHECK(irradia_context_create(&wanted, &context) == IRRADIA_ERROR_DEVICE && context == nullptr);
        const std::string said = irradia_last_error();
        CHECK(said.find(name) != std::string::npos || said.find("VK_EXT_debug_utils") != std::string::npos);
    }
    lent = described_device(on, needs.features);

    show(arguments[1], arguments[2], lent);
    CHECK(turns > 2);

    // Contexts on one device in several threads, each with what it makes.
    std::vector<std::vector<float>> seen(3);
    std::vector<std::thread> threads;
    for (auto &pixels : seen) {
        threads.emplace_back([&pixels, &lent] {
            irradia_context *own = context_on(lent);
            pixels = copied(own);
            irradia_context_destroy(own);
        });
    }
    for (auto &thread : threads) thread.join();
    CHECK(!seen[0].empty() && seen[0] == seen[1] && seen[1] == seen[2]);

    counting = false;
    CHECK(loaded == 0);
    irradia_requirements_destroy(requirements);
    CALL(vkDeviceWaitIdle)(device);
    CALL(vkDestroyDevice)(device, nullptr);
    if (messenger != VK_NULL_HANDLE) CALL(vkDestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    CALL(vkDestroyInstance)(instance, nullptr);
    CHECK(messages == 0);
    return 0;
}
