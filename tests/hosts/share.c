/* Two processes and one picture: share OUTPUT. The one has a frame made into a shared buffer and hands its memory on as a file descriptor; the other imports it into a
 * Vulkan device of its own and writes its 64 x 48 pixels of three floats. Says "no export" where the driver has no such memory. */
#define _GNU_SOURCE
#include "irradia.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#define WIDTH 64
#define HEIGHT 48

static const char *process = "first";

#define CHECK(condition)                                                                                                 \
    do {                                                                                                                 \
        if (!(condition)) {                                                                                              \
            fprintf(stderr, "%s, line %d: %s; last error: %s\n", process, __LINE__, #condition, irradia_last_error());    \
            exit(1);                                                                                                     \
        }                                                                                                                \
    } while (0)
#define OK(call) CHECK((call) == IRRADIA_OK)
#define VK(call) CHECK((call) == VK_SUCCESS)

union control {
    struct cmsghdr header;
    char bytes[CMSG_SPACE(sizeof(int))];
};

static struct msghdr message(struct iovec *data, union control *control) {
    struct msghdr all = {0};
    all.msg_iov = data;
    all.msg_iovlen = 1;
    all.msg_control = control->bytes;
    all.msg_controllen = sizeof control->bytes;
    return all;
}

static void send_memory(int to, irradia_shared_buffer_descriptor what, int fd) {
    struct iovec data = {&what, sizeof what};
    union control control;
    struct msghdr all;
    struct cmsghdr *rights;
    memset(&control, 0, sizeof control);
    all = message(&data, &control);
    rights = CMSG_FIRSTHDR(&all);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof fd);
    memcpy(CMSG_DATA(rights), &fd, sizeof fd);
    CHECK(sendmsg(to, &all, 0) == (ssize_t)sizeof what);
}

static int receive_memory(int from, irradia_shared_buffer_descriptor *what) {
    struct iovec data = {what, sizeof *what};
    union control control;
    struct msghdr all = message(&data, &control);
    int fd = -1;
    if (recvmsg(from, &all, 0) != (ssize_t)sizeof *what) return -1;
    memcpy(&fd, CMSG_DATA(CMSG_FIRSTHDR(&all)), sizeof fd);
    return fd;
}

static VkPhysicalDevice same_device(VkInstance instance, const irradia_shared_buffer_descriptor *what) {
    VkPhysicalDevice devices[16];
    uint32_t count = 16, i;
    vkEnumeratePhysicalDevices(instance, &count, devices);
    for (i = 0; i < count; ++i) {
        VkPhysicalDeviceIDProperties ids = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
        VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &ids};
        vkGetPhysicalDeviceProperties2(devices[i], &all);
        if (!memcmp(ids.deviceUUID, what->device_uuid, 16) && !memcmp(ids.driverUUID, what->driver_uuid, 16)) return devices[i];
    }
    return VK_NULL_HANDLE;
}

static uint32_t visible_type(VkPhysicalDevice physical, uint32_t types) {
    const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties memory;
    uint32_t i;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (i = 0; i < memory.memoryTypeCount; ++i) {
        if (types >> i & 1 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    return UINT32_MAX;
}

/* The other process: what it copies out of the memory that it was handed. */
static int show(int from, const char *path) {
    static const float priority = 1;
    static const char *extension = VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME;
    irradia_shared_buffer_descriptor what;
    const int fd = receive_memory(from, &what);
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkDeviceQueueCreateInfo queue_info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue_info,
                                      .enabledExtensionCount = 1,
                                      .ppEnabledExtensionNames = &extension};
    VkExternalMemoryBufferCreateInfo external = {.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO,
                                                 .handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
    VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .pNext = &external};
    VkMemoryDedicatedAllocateInfo dedicated = {.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO};
    VkImportMemoryFdInfoKHR import = {.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR,
                                      .pNext = &dedicated,
                                      .handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT,
                                      .fd = fd};
    VkMemoryAllocateInfo memory_info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .pNext = &import};
    VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandBufferAllocateInfo commands_info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandBufferCount = 1};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VkBufferMemoryBarrier acquire = {.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL,
                                     .size = VK_WHOLE_SIZE};
    VkBufferCopy region = {.size = 16 * WIDTH * HEIGHT};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1};
    VkMemoryRequirements needs;
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    VkBuffer shared, own;
    VkDeviceMemory shared_memory, own_memory;
    VkCommandPool pool;
    VkCommandBuffer commands;
    const float *pixels;
    void *mapped;
    FILE *file;
    size_t i;

    process = "second";
    if (fd < 0) return 0; /* nothing is shared */
    VK(vkCreateInstance(&instance_info, NULL, &instance));
    physical = same_device(instance, &what);
    CHECK(physical != VK_NULL_HANDLE);
    VK(vkCreateDevice(physical, &device_info, NULL, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);
    buffer_info.size = what.byte_count;
    buffer_info.usage =
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VK(vkCreateBuffer(device, &buffer_info, NULL, &shared));
    dedicated.buffer = shared;
    memory_info.allocationSize = what.memory_byte_count;
    memory_info.memoryTypeIndex = what.memory_type;
    VK(vkAllocateMemory(device, &memory_info, NULL, &shared_memory));
    VK(vkBindBufferMemory(device, shared, shared_memory, 0));
    buffer_info.pNext = NULL;
    buffer_info.size = region.size;
    buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VK(vkCreateBuffer(device, &buffer_info, NULL, &own));
    vkGetBufferMemoryRequirements(device, own, &needs);
    memory_info.pNext = NULL;
    memory_info.allocationSize = needs.size;
    memory_info.memoryTypeIndex = visible_type(physical, needs.memoryTypeBits);
    VK(vkAllocateMemory(device, &memory_info, NULL, &own_memory));
    VK(vkBindBufferMemory(device, own, own_memory, 0));
    VK(vkMapMemory(device, own_memory, 0, VK_WHOLE_SIZE, 0, &mapped));

    VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    commands_info.commandPool = pool;
    VK(vkAllocateCommandBuffers(device, &commands_info, &commands));
    VK(vkBeginCommandBuffer(commands, &begin));
    acquire.buffer = shared;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 1, &acquire, 0,
                         NULL);
    vkCmdCopyBuffer(commands, shared, own, 1, &region);
    VK(vkEndCommandBuffer(commands));
    submit.pCommandBuffers = &commands;
    VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    VK(vkDeviceWaitIdle(device));
    file = fopen(path, "wb");
    CHECK(file);
    for (i = 0, pixels = mapped; i < WIDTH * HEIGHT; ++i) CHECK(fwrite(pixels + 4 * i, sizeof(float), 3, file) == 3);
    fclose(file);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyBuffer(device, own, NULL);
    vkDestroyBuffer(device, shared, NULL);
    vkFreeMemory(device, own_memory, NULL);
    vkFreeMemory(device, shared_memory, NULL);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return 0;
}

/* The one that has the frame made. */
static void share(int to) {
    irradia_context *context = NULL;
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_frame *frame = NULL;
    irradia_shared_buffer *buffer = NULL, *little = NULL;
    irradia_shared_buffer_descriptor what = {.size = sizeof what};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_target_descriptor target = {.size = sizeof target};
    uint64_t resource;
    size_t held;
    int32_t fd;

    OK(irradia_context_create(NULL, &context));
    if (irradia_shared_buffer_create(context, 16 * WIDTH * HEIGHT, &buffer) == IRRADIA_ERROR_DEVICE) {
        CHECK(buffer == NULL);
        printf("no export: %s\n", irradia_last_error());
        irradia_context_destroy(context);
        return;
    }
    OK(irradia_shared_buffer_get(buffer, &what));
    CHECK(what.byte_count == 16 * WIDTH * HEIGHT && what.memory_byte_count >= what.byte_count && what.resource != 0);
    CHECK(irradia_shared_buffer_create(context, 0, &little) == IRRADIA_ERROR_ARGUMENT);
    OK(irradia_shared_buffer_create(context, 16 * WIDTH * HEIGHT - 16, &little));

    OK(irradia_scene_open(context, "cornell-point", NULL, &scene));
    OK(irradia_renderer_create(context, NULL, &renderer));
    wanted.width = WIDTH;
    wanted.height = HEIGHT;
    wanted.stay_on_device = 1;
    wanted.targets = &target;
    wanted.target_count = 1;
    target.slot = IRRADIA_SLOT_IMAGE;
    target.is_buffer = 1;
    target.before.family = IRRADIA_FAMILY_SAME;
    target.after.family = VK_QUEUE_FAMILY_EXTERNAL;

    /* Not ours, too small, no longer there, an image. */
    resource = what.resource;
    target.resource = resource + 1;
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_ARGUMENT);
    OK(irradia_shared_buffer_get(little, &what));
    target.resource = what.resource;
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_ARGUMENT);
    irradia_shared_buffer_destroy(little);
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_ARGUMENT);
    target.resource = resource;
    target.offset = 16;
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_ARGUMENT);
    target.offset = 0;
    target.is_buffer = 0;
    target.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    target.after.layout = VK_IMAGE_LAYOUT_GENERAL;
    CHECK(irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_ERROR_ARGUMENT);
    target.is_buffer = 1;

    OK(irradia_render(renderer, scene, &wanted, &frame));
    irradia_frame_destroy(frame);
    OK(irradia_shared_buffer_get(buffer, &what));
    OK(irradia_shared_buffer_export(buffer, &fd));
    send_memory(to, what, fd);
    close(fd);
    OK(irradia_context_allocations(context, &held, NULL));
    CHECK(held > 0);
    irradia_renderer_destroy(renderer);
    irradia_shared_buffer_destroy(buffer);
    OK(irradia_context_allocations(context, &held, NULL));
    CHECK(held == 0);
    irradia_scene_destroy(scene);
    irradia_context_destroy(context);
}

int main(int count, char **arguments) {
    int ends[2], done = 1;
    pid_t other;
    CHECK(count == 2 && socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0);
    other = fork();
    CHECK(other >= 0);
    if (other == 0) {
        close(ends[0]);
        return show(ends[1], arguments[1]);
    }
    close(ends[1]);
    share(ends[0]);
    send(ends[0], "", 0, 0); /* Ends the wait of the other where nothing was shared. */
    close(ends[0]);
    CHECK(waitpid(other, &done, 0) == other && WIFEXITED(done) && WEXITSTATUS(done) == 0);
    return 0;
}
