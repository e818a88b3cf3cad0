/*
 * irradia: a headless Vulkan engine for global illumination, as a C library.
 *
 * A context is a device. A scene is what there is to light: from a file, or built from the program's own meshes, materials and lights. A renderer has settings
 * and keeps on the device what still holds from one frame to the next. A frame has pixels, and what each of its passes cost.
 *
 *     irradia_context *context = NULL;
 *     irradia_scene *scene = NULL;
 *     irradia_renderer *renderer = NULL;
 *     irradia_frame *frame = NULL;
 *     if (irradia_context_create(NULL, &context) == IRRADIA_OK &&
 *         irradia_scene_open(context, "room.glb", NULL, &scene) == IRRADIA_OK &&
 *         irradia_renderer_create(context, NULL, &renderer) == IRRADIA_OK) {
 *         irradia_frame_descriptor wanted = {.size = sizeof wanted};
 *         wanted.width = 512;
 *         wanted.height = 512;
 *         if (irradia_render(renderer, scene, &wanted, &frame) == IRRADIA_OK) {
 *             static float pixels[512 * 512 * 3];
 *             irradia_pixels_descriptor target = {.size = sizeof target};
 *             target.slot = IRRADIA_SLOT_IMAGE;
 *             target.pixels = pixels;
 *             target.byte_count = sizeof pixels;
 *             irradia_frame_copy(frame, &target);
 *         }
 *     }
 *     if (!frame) fprintf(stderr, "%s\n", irradia_last_error());
 *     irradia_frame_destroy(frame);
 *     irradia_renderer_destroy(renderer);
 *     irradia_scene_destroy(scene);
 *     irradia_context_destroy(context);
 *
 * RULES, for every function unless it says otherwise
 *
 * Status.     What can fail returns an irradia_status. Beside IRRADIA_OK, irradia_last_error() has one sentence on what, where and what to do, for this thread.
 *             A call that fails changes nothing but what it says; what it was to give is then null, or 0. No call ends the process, throws, or writes to the terminal.
 * Pointers.   A pointer is to what its description says, or null where that says so; null elsewhere is IRRADIA_ERROR_ARGUMENT. What a call is given it reads or
 *             fills before it returns, and keeps no pointer to, but for callbacks and what they are given. Texts are UTF-8 and end in a zero.
 * Descriptors begin with their size: write `irradia_x_descriptor d = {.size = sizeof d};`, in C++ `irradia_x_descriptor d{}; d.size = sizeof d;`: that leaves zeros in
 *             the rest, and zeros are the defaults unless a field says otherwise. So a program that
 *             was built with an older header runs with a newer library. A newer program is refused by an older library, IRRADIA_ERROR_VERSION, if it uses
 *             what that library does not have, and served if it does not. Functions that fill a descriptor fill as much of it as its size says.
 * Numbers.    Choices and booleans are uint32_t and checked. Metres, radians, seconds, watts; linear Rec. 709. +Y is up. Matrices are 4x4, column after column.
 * Handles.    Each is ended by its destroy function, once; what was destroyed must not be used again, which is not caught. The order does not matter:
 *             a renderer keeps its context's device open. A handle is used by one call at a time, IRRADIA_ERROR_BUSY otherwise, a context by any number.
 * Threads.    Any thread may make any call. Callbacks come from the thread that made the call or from the library's own; each says which, and how many at a time.
 *             A context has a thread for each processor, which end with it. Outside of contexts there are only the threads that scenes without a context use.
 * Versions.   What is here is experimental while the major version is 0: another minor version may change it. IRRADIA_VERSION is the header's version,
 *             irradia_version() the library's.
 */

#ifndef IRRADIA_H
#define IRRADIA_H

#include <stddef.h>
#include <stdint.h>

// Version of this header: major · 10000 + minor · 100 + patch. While the major version is 0, another minor version may change what is here.
#define IRRADIA_VERSION 100

// Central projection by its vertical angle.
#define IRRADIA_PROJECTION_PERSPECTIVE 0

// Parallel projection by half its width and height.
#define IRRADIA_PROJECTION_ORTHOGRAPHIC 1

// Either of them by its matrix.
#define IRRADIA_PROJECTION_MATRIX 2

// No validation layer.
#define IRRADIA_VALIDATION_OFF 0

// Correct use of the interface.
#define IRRADIA_VALIDATION_CORE 1

// The same, and hazards between commands.
#define IRRADIA_VALIDATION_SYNCHRONIZATION 2

// Correct use, and shaders that check their memory accesses; slow.
#define IRRADIA_VALIDATION_GPU 3

// The ACES filmic curve, after exposure to the log-average luminance.
#define IRRADIA_TONE_MAP_ACES 0

// Drago's adaptive logarithmic mapping.
#define IRRADIA_TONE_MAP_DRAGO 1

// Radiance 1 is white.
#define IRRADIA_TONE_MAP_LINEAR 2

// The frame as a whole is timed.
#define IRRADIA_TIMING_FRAME 0

// Every pass is timed alone, which takes longer.
#define IRRADIA_TIMING_PASSES 1

// Something failed, or a fault of the library's own.
#define IRRADIA_LOG_ERROR 1

// Something is not as it was asked for.
#define IRRADIA_LOG_WARNING 2

// What it does, now and then.
#define IRRADIA_LOG_INFO 3

// What it does, in detail.
#define IRRADIA_LOG_DEBUG 4

// A whole number, `least` to `most`.
#define IRRADIA_OPTION_INTEGER 1

// The same, or "null" for no limit.
#define IRRADIA_OPTION_LIMIT 2

// One of some whole numbers, which `takes` lists.
#define IRRADIA_OPTION_ONE_OF 3

// A number, `least` to `most`.
#define IRRADIA_OPTION_NUMBER 4

// One of some names, which `takes` lists.
#define IRRADIA_OPTION_CHOICE 5

// A text; `takes` says which.
#define IRRADIA_OPTION_TEXT 6

// Red, green, blue, each a 32-bit float.
#define IRRADIA_PIXELS_RGB32F 0

// The same and an alpha of 1.
#define IRRADIA_PIXELS_RGBA32F 1

// Red, green, blue, each a 16-bit float; beyond 65504 infinite.
#define IRRADIA_PIXELS_RGB16F 2

// The same and an alpha of 1.
#define IRRADIA_PIXELS_RGBA16F 3

// Red, green, blue, each a byte; of IRRADIA_SLOT_DISPLAY alone.
#define IRRADIA_PIXELS_RGB8 4

// The same and an alpha of 255.
#define IRRADIA_PIXELS_RGBA8 5

// Shines alike in all directions; intensity in W/sr.
#define IRRADIA_LIGHT_POINT 0

// Shines along the -Z of its node, fully within `inner_angle`, not outside `outer_angle`; intensity on its axis in W/sr.
#define IRRADIA_LIGHT_SPOT 1

// Parallel light along the -Z of its node; intensity across it in W/m².
#define IRRADIA_LIGHT_DIRECTIONAL 2

// 32-bit floats.
#define IRRADIA_FORMAT_FLOAT32 0

// Bytes that stand for 0 to 1.
#define IRRADIA_FORMAT_UNORM8 1

// 16-bit whole numbers that stand for 0 to 1.
#define IRRADIA_FORMAT_UNORM16 2

// 32-bit indices.
#define IRRADIA_INDEX_UINT32 0

// 16-bit indices.
#define IRRADIA_INDEX_UINT16 1

// Outside 0 to 1 the texture starts again.
#define IRRADIA_WRAP_REPEAT 0

// It turns back.
#define IRRADIA_WRAP_MIRROR 1

// Its border goes on.
#define IRRADIA_WRAP_CLAMP 2

// Meshes.
#define IRRADIA_KIND_MESH 1

// Materials.
#define IRRADIA_KIND_MATERIAL 2

// Textures.
#define IRRADIA_KIND_TEXTURE 3

// Nodes.
#define IRRADIA_KIND_NODE 4

// Punctual lights.
#define IRRADIA_KIND_LIGHT 5

// Cameras that nodes place.
#define IRRADIA_KIND_CAMERA 6

// What loading had to leave out or change: sentences, which stand for names here.
#define IRRADIA_KIND_WARNING 7

// What the surfaces themselves emit, and the sky where no surface is.
#define IRRADIA_SLOT_EMISSION 1

// Light from the lights, shadowed.
#define IRRADIA_SLOT_DIRECT 2

// Light that was scattered diffusely before.
#define IRRADIA_SLOT_DIFFUSE 4

// Light that was reflected or refracted before, on diffuse surfaces.
#define IRRADIA_SLOT_CAUSTICS 8

// What mirrors, metals and glass show, but for the lights.
#define IRRADIA_SLOT_SPECULAR 16

// The sum of all slots.
#define IRRADIA_SLOT_IMAGE 32

// The image for a display: sRGB, 8 bits, by the tone map of the frame.
#define IRRADIA_SLOT_DISPLAY 64

// Of a resource that no other queue family owns.
#define IRRADIA_FAMILY_SAME 4294967295

// A Vulkan device and what is shared on it. Its calls may come from several threads at once.
typedef struct irradia_context irradia_context;

// A finished frame: pixels, and what it cost. Needs neither the renderer nor the scene any more.
typedef struct irradia_frame irradia_frame;

// Settings, and what frames leave on the device for the next one. One call at a time may use it, but for irradia_renderer_cancel().
typedef struct irradia_renderer irradia_renderer;

// What a device must be created with, for irradia to use it.
typedef struct irradia_requirements irradia_requirements;

// What there is to light. One call at a time may use it; irradia_render() reads it during the call alone.
typedef struct irradia_scene irradia_scene;

// A buffer whose memory other processes can import. Frames of its context fill it as a target. Its calls may come from several threads at once.
typedef struct irradia_shared_buffer irradia_shared_buffer;

// What every call that can fail returns: IRRADIA_OK, or one of IRRADIA_ERROR_…; irradia_last_error() has the sentence.
typedef uint32_t irradia_status;

// A camera in the world. It looks along its -Z, +Y is up.
typedef struct {
    // sizeof(irradia_camera_descriptor).
    size_t size;
    // Camera space to world space, the inverse of a view matrix: 4×4, column after column. A rigid motion; what is not one is made one. All zero: the identity.
    double world_from_camera[16];
    // One of IRRADIA_PROJECTION_….
    uint32_t projection;
    // Zero.
    uint32_t reserved;
    // Full angle of a perspective, radians, above 0 and below π.
    double vertical_fov;
    // Nearest distance seen, metres; above 0 in a perspective.
    double near;
    // Farthest distance that an orthographic camera sees, metres. A perspective has no far plane.
    double far;
    // Half the width of what an orthographic camera sees, metres.
    double half_width;
    // Half the height, metres.
    double half_height;
    // For IRRADIA_PROJECTION_MATRIX: camera space to clip space, column after column, y up or down. Its depth is not looked at: `near` and `far` say that. It
    // must be centred, and as wide as the frame.
    double clip_from_camera[16];
} irradia_camera_descriptor;

// Names a thing in a scene: 1 for the first of its kind, 2 for the second. 0: none.
typedef uint32_t irradia_id;

// Hears what the library says: one message, UTF-8, which stands during the call. It may be called from any thread, the library's own included, and from
// several at once. It must not call the library.
typedef void (*irradia_log_function)(void *user, uint32_t level, const char *message);

// A function of no known type: vkGetInstanceProcAddr, cast.
typedef void (*irradia_void_function)(void);

// A host's instance and one of its physical devices.
typedef struct {
    // sizeof(irradia_instance_descriptor).
    size_t size;
    // vkGetInstanceProcAddr, cast. Everything else is looked up by it: the library opens no loader.
    irradia_void_function get_instance_proc_addr;
    // VkInstance.
    void *instance;
    // VkPhysicalDevice.
    void *physical_device;
    // The apiVersion that the instance was created for, at least VK_API_VERSION_1_3.
    uint32_t api_version;
    // Zero.
    uint32_t reserved;
} irradia_instance_descriptor;

// Called before and after every submission to the host's queue. From any thread, by one at a time; it must not call the library.
typedef void (*irradia_queue_function)(void *user);

// A host's device. It and all that it stands on must outlive the context and what was made on it. Nothing of it is destroyed.
typedef struct {
    // sizeof(irradia_device_descriptor).
    size_t size;
    // Its instance and physical device.
    const irradia_instance_descriptor *instance;
    // VkDevice.
    void *device;
    // VkQueue, for graphics and compute.
    void *queue;
    // The queue's family.
    uint32_t queue_family;
    // 1: VK_EXT_debug_utils is enabled on the instance; passes and objects then have names in the host's tools.
    uint32_t debug_utils;
    // The VkPhysicalDeviceFeatures2 of what was enabled, with the structs behind it, as it stood behind VkDeviceCreateInfo; it may be the one of
    // irradia_requirements_get(). Not needed any more once the call returns.
    const void *features;
    // Called before each submission to the queue; null: nobody else uses the queue while a call of the library is in progress, another context on it included.
    irradia_queue_function lock_queue;
    // Called after it.
    irradia_queue_function unlock_queue;
    // Given to both.
    void *queue_user;
} irradia_device_descriptor;

// How a context is made.
typedef struct {
    // sizeof(irradia_context_descriptor).
    size_t size;
    // A part of the device's name, or its index; null: the first discrete GPU, else integrated, else CPU.
    const char *device;
    // One of IRRADIA_VALIDATION_…. Beside 0 the validation layer must be installed.
    uint32_t validation;
    // The least urgent messages that `log` hears, one of IRRADIA_LOG_…; 0: IRRADIA_LOG_WARNING.
    uint32_t log_level;
    // Hears what the library says; null: nobody does.
    irradia_log_function log;
    // Given to `log`.
    void *log_user;
    // The host's own device in place of one of the library's; `device` and `validation` must be zero then. Null: the library opens one.
    const irradia_device_descriptor *host_device;
} irradia_context_descriptor;

// Hears how far a frame is: `done` from 0 to 1. Returns 0 to go on, anything else to stop: the call then returns IRRADIA_ERROR_CANCELLED.
//
// It is called from the thread that called irradia_render() or one of the library's own, one call at a time. It must not call the library, but for
// irradia_renderer_cancel().
typedef uint32_t (*irradia_progress_function)(void *user, double done);

// How the host uses a resource before or after the copy: a half of its barrier.
typedef struct {
    // VkImageLayout; before, VK_IMAGE_LAYOUT_UNDEFINED if what it holds is of no interest. Without meaning for buffers.
    uint32_t layout;
    // The queue family that owns it, which then has the other half of the barrier; IRRADIA_FAMILY_SAME: that of the context's queue.
    uint32_t family;
    // VkPipelineStageFlags2 of the uses before, or after.
    uint64_t stages;
    // VkAccessFlags2 of these.
    uint64_t access;
} irradia_resource_use;

// Where a slot is left on the device: an image or a buffer of the host's device, or a shared buffer of the context. The copy is one command; nothing of it passes through
// the host's memory.
typedef struct {
    // sizeof(irradia_target_descriptor), in each of an array.
    size_t size;
    // One of IRRADIA_SLOT_… but IRRADIA_SLOT_DISPLAY. Radiance in W/(m² sr), linear Rec. 709; a fourth channel of no meaning.
    uint32_t slot;
    // 1: `resource` is a VkBuffer with VK_BUFFER_USAGE_TRANSFER_DST_BIT, four floats a pixel. 0: a VkImage with VK_IMAGE_USAGE_TRANSFER_DST_BIT, of two dimensions, at least as
    // large as the frame, of which the first layer of the first mip level is filled.
    uint32_t is_buffer;
    // The handle.
    uint64_t resource;
    // Of an image, its VkFormat. VK_FORMAT_R32G32B32A32_SFLOAT is copied; other colours in floats, in parts of 1 or in sRGB are converted as vkCmdBlitImage does, if the
    // device can.
    uint32_t format;
    // Of a buffer, pixels from one row to the next; 0: the frame's width.
    uint32_t row_pixels;
    // Of a buffer, bytes to the first pixel, a multiple of 16.
    uint64_t offset;
    // How the host used it until now.
    irradia_resource_use before;
    // How the host will use it.
    irradia_resource_use after;
} irradia_target_descriptor;

// A timeline semaphore of the context's device, and a value of it.
typedef struct {
    // VkSemaphore of type VK_SEMAPHORE_TYPE_TIMELINE.
    uint64_t semaphore;
    // Its value.
    uint64_t value;
} irradia_semaphore_point;

// What is asked of one frame.
typedef struct {
    // sizeof(irradia_frame_descriptor).
    size_t size;
    // Pixels, at least 1.
    uint32_t width;
    // Pixels, at least 1.
    uint32_t height;
    // From where; null: from the scene's camera `camera_name`.
    const irradia_camera_descriptor *camera;
    // As for irradia_scene_camera(); null: the scene's first, or a view that shows it.
    const char *camera_name;
    // What is wanted: a sum of IRRADIA_SLOT_…; 0: IRRADIA_SLOT_IMAGE. What nobody wants is not made.
    uint32_t slots;
    // Of IRRADIA_SLOT_DISPLAY, one of IRRADIA_TONE_MAP_….
    uint32_t tone_map;
    // The frame's number: what varies from frame to frame, such as the directions of samples, varies by it.
    uint32_t index;
    // Seconds since the frame before, at least 0; 0: time stands still.
    float time_step;
    // One of IRRADIA_TIMING_….
    uint32_t timing;
    // Zero.
    uint32_t reserved;
    // Hears how far the frame is; may be null.
    irradia_progress_function progress;
    // Given to `progress`.
    void *progress_user;
    // What is left on the device; an array whose elements are as far apart as the size of the first one says. Their slots need not be in `slots`.
    const irradia_target_descriptor *targets;
    // How many.
    size_t target_count;
    // 1: nothing is copied to the host's memory; irradia_frame_copy() has nothing to copy then, and 0 of `slots` means none. Of `targets` the host reads how many
    // pixels are not finite, a word each, and no pixel.
    uint32_t stay_on_device;
    // How long points are waited for, seconds; 0: 10. A point that is not reached by then is IRRADIA_ERROR_DEVICE, and nothing is signalled.
    float patience;
    // Points that must be reached before targets are touched. What signals them must have been submitted before this call, which blocks until they are, before it
    // begins with the frame.
    const irradia_semaphore_point *waits;
    // How many.
    size_t wait_count;
    // Points that are signalled once all targets are filled. A call that fails signals none.
    const irradia_semaphore_point *signals;
    // How many.
    size_t signal_count;
} irradia_frame_descriptor;

// Where pixels go.
typedef struct {
    // sizeof(irradia_pixels_descriptor).
    size_t size;
    // One of IRRADIA_SLOT_…, which the frame was asked for. Radiance in W/(m² sr), linear Rec. 709.
    uint32_t slot;
    // One of IRRADIA_PIXELS_….
    uint32_t format;
    // Receives the rows, the top one first.
    void *pixels;
    // Bytes that may be written there.
    size_t byte_count;
    // Bytes from one row to the next; 0: rows lie one behind the other. Between rows nothing is written.
    size_t row_stride;
} irradia_pixels_descriptor;

// How a renderer begins.
typedef struct {
    // sizeof(irradia_renderer_descriptor).
    size_t size;
    // A technique's name, such as "hybrid" or "path"; null: "hybrid". A name that does not exist is answered by the list.
    const char *technique;
    // "default", "draft", "high" or "paper"; null: "default".
    const char *preset;
} irradia_renderer_descriptor;

// One setting: what irradia_renderer_set() takes. The texts stand as long as the renderer does.
typedef struct {
    // sizeof(irradia_option_descriptor).
    size_t size;
    // "piece.name".
    const char *key;
    // One of IRRADIA_OPTION_….
    uint32_t kind;
    // Zero.
    uint32_t reserved;
    // The least number; 0 where none are taken.
    double least;
    // The greatest number; 0 where none are taken.
    double most;
    // What it takes, in words.
    const char *takes;
    // What it is counted in; empty for names and shares.
    const char *unit;
    // How a frame's time grows with it; empty where it does not.
    const char *cost;
    // What it means.
    const char *documentation;
} irradia_option_descriptor;

// A light without area. Surfaces shine by their materials' `emissive`.
typedef struct {
    // sizeof(irradia_light_descriptor).
    size_t size;
    // Null: none.
    const char *name;
    // One of IRRADIA_LIGHT_….
    uint32_t kind;
    // Linear red, green, blue, finite and at least 0; the unit is the kind's.
    float intensity[3];
    // Half angle of a spot, radians, 0 to `outer_angle`.
    float inner_angle;
    // Half angle of a spot, radians, above 0 to π/2. Between the two it falls off as glTF says.
    float outer_angle;
    // Distance in metres beyond which the light may be ignored; 0: none.
    float range;
    // Zero.
    uint32_t reserved;
} irradia_light_descriptor;

// What loading may do. Zeros are the defaults, which are safe for scenes of unknown origin.
typedef struct {
    // sizeof(irradia_load_descriptor).
    size_t size;
    // 1: the glTF file may name files outside of its own folder. 0: not.
    uint32_t allow_outside_files;
    // Longest side of an image, texels; 0: 16384.
    uint32_t image_side;
    // Bytes of all textures at four a texel; 0: 4 GiB.
    uint64_t texture_bytes;
    // Bytes of the scene's files together; 0: 8 GiB.
    uint64_t file_bytes;
} irradia_load_descriptor;

// Reads a file of the host's that a glTF file names.
//
// `uri`: its name as the glTF file has it, percent-encoding undone, UTF-8.
// `buffer`: null: only the length is asked for. Otherwise `capacity` bytes to fill.
// `length`: to be set to the file's length in bytes.
//
// Returns 0, or anything else where there is no such file. It may be called from threads of the library's own, one call at a time, while the scene is being
// loaded. It must not call the library.
typedef uint32_t (*irradia_read_function)(void *user, const char *uri, void *buffer, size_t capacity, size_t *length);

// A glTF file in memory.
typedef struct {
    // sizeof(irradia_scene_bytes).
    size_t size;
    // What messages call the scene; null: "scene".
    const char *name;
    // The bytes of a .gltf or .glb file; not needed any more once the call returns.
    const void *bytes;
    // How many.
    size_t byte_count;
    // Reads the files that it names; null: a file that names others is an error.
    irradia_read_function read;
    // Given to `read`.
    void *read_user;
} irradia_scene_bytes;

// One use of a texture.
typedef struct {
    // The texture; 0: none.
    irradia_id texture;
    // Set of texture coordinates, 0 or 1.
    uint32_t texcoord;
    // 2×3, row after row, applied to (u, v, 1); all zero: the identity.
    float transform[6];
} irradia_texture_use;

// How a surface scatters, transmits and emits light, as glTF 2.0 and its KHR extensions say. Factors multiply their textures.
// irradia_material_default() fills it with the default material, white and rough.
typedef struct {
    // sizeof(irradia_material_descriptor).
    size_t size;
    // Null: none. Read by irradia_scene_get_material() as null: irradia_scene_name() has it.
    const char *name;
    // Linear red, green, blue reflectance and opacity, 0 to 1.
    float base_color[4];
    // 0 dielectric to 1 metal.
    float metallic;
    // 0 mirror to 1; GGX alpha is its square.
    float roughness;
    // Emitted radiance, linear, W/(m² sr).
    float emissive[3];
    // Index of refraction, at least 1; 0: a Fresnel reflectance of 1.
    float ior;
    // Strength of a dielectric's specular lobe, 0 to 1.
    float specular;
    // Colour of a dielectric's reflectance at normal incidence, linear.
    float specular_color[3];
    // Share of the base that transmits rather than scatters, 0 to 1.
    float transmission;
    // Above 0: the border of a closed solid, which refracts; 0: a thin wall. Metres.
    float thickness;
    // Metres after which light inside has become `attenuation_color`; infinite without absorption.
    float attenuation_distance;
    // Linear, 0 to 1.
    float attenuation_color[3];
    // Factor on x and y of the normal texture.
    float normal_scale;
    // The surface is there where alpha is at least this, 0 to 1; negative: everywhere.
    float alpha_cutoff;
    // 1: the back is shaded, and emits, as the front is.
    uint32_t double_sided;
    // 1: the base colour is shown as it is, scatters nothing and lights nothing.
    uint32_t unlit;
    // Colour in sRGB, alpha linear.
    irradia_texture_use base_color_texture;
    // Roughness in green, metallic in blue.
    irradia_texture_use metallic_roughness_texture;
    // Normals in tangent space.
    irradia_texture_use normal_texture;
    // sRGB.
    irradia_texture_use emissive_texture;
    // Transmission in red.
    irradia_texture_use transmission_texture;
    // Specular strength in alpha.
    irradia_texture_use specular_texture;
    // sRGB.
    irradia_texture_use specular_color_texture;
} irradia_material_descriptor;

// One attribute of all vertices.
typedef struct {
    // The first vertex's; null: the vertices do not have it.
    const void *data;
    // Bytes from one vertex to the next; 0: they lie one behind the other.
    size_t stride;
    // One of IRRADIA_FORMAT_…; positions, normals and tangents are floats.
    uint32_t format;
    // Zero.
    uint32_t reserved;
} irradia_vertex_attribute;

// A list of triangles with one material.
typedef struct {
    // sizeof(irradia_primitive_descriptor), in each of an array.
    size_t size;
    // The material; not 0.
    irradia_id material;
    // One of IRRADIA_INDEX_….
    uint32_t index_format;
    // Three indices a triangle, counter-clockwise as its front is seen; null: vertices in their order.
    const void *indices;
    // How many.
    size_t index_count;
    // How many vertices.
    size_t vertex_count;
    // x, y, z; metres after the node's transform. Finite.
    irradia_vertex_attribute positions;
    // x, y, z; made unit vectors. Without them triangles are flat.
    irradia_vertex_attribute normals;
    // x, y, z along +u, and ±1: the bitangent is that times normal × tangent. Where a normal texture needs them and they are not given, they are made. They are kept
    // where the material has a normal texture when the mesh is given: set the material first, or the mesh again.
    irradia_vertex_attribute tangents;
    // u, v of the sets 0 and 1; v grows downwards in the image.
    irradia_vertex_attribute texcoords[2];
    // Linear red, green, blue, alpha, which multiply the base colour.
    irradia_vertex_attribute colors;
} irradia_primitive_descriptor;

// Primitives that nodes place together.
typedef struct {
    // sizeof(irradia_mesh_descriptor).
    size_t size;
    // Null: none.
    const char *name;
    // An array; its elements are as far apart as the size of the first one says.
    const irradia_primitive_descriptor *primitives;
    // How many.
    size_t primitive_count;
} irradia_mesh_descriptor;

// A place in the scene, and what stands there.
typedef struct {
    // sizeof(irradia_node_descriptor).
    size_t size;
    // Null: none.
    const char *name;
    // The node in whose space `local` is; 0: the world. It must be there already.
    irradia_id parent;
    // The mesh that stands here; 0: none.
    irradia_id mesh;
    // The light that shines from here along -Z; 0: none.
    irradia_id light;
    // The camera that looks from here along -Z; 0: none.
    irradia_id camera;
    // Node space to parent space, metres: 4×4, column after column, the last row 0 0 0 1. All zero: the identity.
    double local[16];
} irradia_node_descriptor;

// Texels, and how they are read.
typedef struct {
    // sizeof(irradia_texture_descriptor).
    size_t size;
    // Null: none.
    const char *name;
    // Texels in a row, at least 1.
    uint32_t width;
    // Rows, at least 1; the top one is first.
    uint32_t height;
    // Four bytes a texel: red, green, blue, alpha. Copied by the call.
    const void *texels;
    // Bytes from one row to the next; 0: 4 · width.
    size_t row_stride;
    // Along u and along v, IRRADIA_WRAP_….
    uint32_t wrap[2];
    // 1: red, green and blue are sRGB-encoded, as base and emissive colours are; 0: linear. Alpha is always linear.
    uint32_t srgb;
    // 1: magnified texels stay squares.
    uint32_t nearest;
} irradia_texture_descriptor;

// What another process needs to import a shared buffer's memory: VkImportMemoryFdInfoKHR with VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, and a VkBuffer of
// `byte_count` bytes for transfers from and to it and as a storage buffer, to which that memory is dedicated.
typedef struct {
    // sizeof(irradia_shared_buffer_descriptor).
    size_t size;
    // For irradia_target_descriptor::resource of this context's frames.
    uint64_t resource;
    // Bytes of the buffer.
    uint64_t byte_count;
    // Bytes of its memory: VkMemoryAllocateInfo::allocationSize.
    uint64_t memory_byte_count;
    // VkMemoryAllocateInfo::memoryTypeIndex, on the same device.
    uint32_t memory_type;
    // Zero.
    uint32_t reserved;
    // VkPhysicalDeviceIDProperties::deviceUUID of the context's device, and the driver's: only where both agree can the memory be imported.
    uint8_t device_uuid[16];
    // VkPhysicalDeviceIDProperties::driverUUID.
    uint8_t driver_uuid[16];
} irradia_shared_buffer_descriptor;

// What a frame cost as a whole.
typedef struct {
    // sizeof(irradia_timings_descriptor).
    size_t size;
    // Milliseconds on the device, from the frame's start to its end.
    double gpu_ms;
    // Milliseconds of the call.
    double host_ms;
    // Of these: bringing what changed of the scene onto the device.
    double upload_ms;
    // Of these: compiling pipelines; 0 once they exist.
    double pipeline_ms;
    // How many passes irradia_frame_pass() tells of, the skipped ones included.
    size_t pass_count;
    // How many pieces irradia_frame_memory() tells of.
    size_t memory_count;
    // Samples of every pixel, of `path` and `sppm`; otherwise 0.
    uint32_t samples;
    // Zero.
    uint32_t reserved;
    // Rays that these took.
    uint64_t rays;
    // Bytes of `upload_ms`: vertices, instances, materials, textures, as rasterisers read them.
    uint64_t upload_bytes;
} irradia_timings_descriptor;

// One pass. The texts stand as long as the frame does.
typedef struct {
    // sizeof(irradia_pass_descriptor).
    size_t size;
    // Its piece and its name, "diffuse/vpl/gather".
    const char *name;
    // Milliseconds on the device; negative if it was not timed or did not run.
    double ms;
    // Why it did not run; null: it did.
    const char *skipped;
} irradia_pass_descriptor;

// What one piece holds on the device. The text stands as long as the frame does.
typedef struct {
    // sizeof(irradia_memory_descriptor).
    size_t size;
    // The piece; "scene" is the scene itself.
    const char *piece;
    // Bytes.
    uint64_t bytes;
} irradia_memory_descriptor;

// What a device must be created with. It stands as long as the irradia_requirements that it came from.
typedef struct {
    // sizeof(irradia_requirements_descriptor).
    size_t size;
    // A VkPhysicalDeviceFeatures2 and the structs behind it, for VkDeviceCreateInfo::pNext: what is required, and of the rest what is used where it is there.
    // A host with features of its own sets theirs beside these instead.
    const void *features;
    // Extensions that must be enabled: none.
    const char *const *extensions;
    // How many.
    size_t extension_count;
    // A family with graphics, compute and timestamps; another one with these serves too.
    uint32_t queue_family;
    // The least apiVersion of instance and device.
    uint32_t api_version;
} irradia_requirements_descriptor;

// Done.
#define IRRADIA_OK 0

// An argument cannot be what it is: null, out of range, not finite, a descriptor without its size. Nothing changed.
#define IRRADIA_ERROR_ARGUMENT 1

// A scene, its file or something in it is at fault. Nothing changed.
#define IRRADIA_ERROR_SCENE 2

// There is no such setting, or it does not take this value. The old settings stand.
#define IRRADIA_ERROR_SETTINGS 3

// No Vulkan loader, no device, or not one that can do what is asked.
#define IRRADIA_ERROR_DEVICE 4

// The device has no memory left for this.
#define IRRADIA_ERROR_MEMORY 5

// The device was lost. Destroy the renderers and the context; nothing else works on them any more.
#define IRRADIA_ERROR_DEVICE_LOST 6

// The program was built for a newer library and asks for what this one does not know.
#define IRRADIA_ERROR_VERSION 7

// Another thread uses this handle now.
#define IRRADIA_ERROR_BUSY 8

// irradia_renderer_cancel() stopped it. The renderer can go on.
#define IRRADIA_ERROR_CANCELLED 9

// A fault of the library's own. After one that the sentence calls a failure of the library the handles of the call refuse to be used; destroy them.
#define IRRADIA_ERROR_INTERNAL 10

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library, in the form of IRRADIA_VERSION: that of the header that it was built with. Needs nothing, from any thread.
uint32_t irradia_version(void);

// Fills a descriptor, whose size is set, with a camera of the scene.
//
// `name`: its name, its node's, or its number as text, 0 for the first; null: the first, or a view that shows the scene if it has none.
irradia_status irradia_scene_camera(const irradia_scene *scene,
                                    const char *name,
                                    irradia_camera_descriptor *camera);

// Adds a camera; a node must place it before one can look through it, by its name or its number. It moves as its node does.
//
// `name`: null: none. `descriptor`: how it projects; its `world_from_camera` is all zero. A matrix must be as wide as the frames that are taken through it: only their
// height is looked at.
// `id`: receives its identifier; may be null.
//
// Errors: IRRADIA_ERROR_SCENE for a projection out of range.
irradia_status irradia_scene_add_camera(irradia_scene *scene,
                                        const char *name,
                                        const irradia_camera_descriptor *descriptor,
                                        irradia_id *id);

// Replaces a camera, its name too.
irradia_status irradia_scene_set_camera(irradia_scene *scene,
                                        irradia_id id,
                                        const char *name,
                                        const irradia_camera_descriptor *descriptor);

// Opens a device.
//
// `descriptor`: null for a descriptor of zeros: the default device, no validation, no log.
// `context`: receives the new context, which irradia_context_destroy() ends; null where the call fails.
//
// Errors: IRRADIA_ERROR_DEVICE without a Vulkan 1.3 loader, a device that can be used, or the validation layer that was asked for; IRRADIA_ERROR_ARGUMENT.
// From any thread. Takes tens of milliseconds.
irradia_status irradia_context_create(const irradia_context_descriptor *descriptor,
                                      irradia_context **context);

// Ends a context. What was made on it and is still there keeps its device open until it is destroyed too. Null is allowed.
//
// From any thread, once, with no other call on it in progress.
void irradia_context_destroy(irradia_context *context);

// The name of the device in use, UTF-8. Stands as long as the context does. Null for a null context.
const char *irradia_context_device_name(const irradia_context *context);

// What the validation layer found so far: how many messages, and one of them.
//
// `count`: receives their number; may be null.
// `index`, `buffer`, `capacity`, `needed`: the message to copy, as irradia_renderer_settings() copies; `buffer` and `needed` null: none.
//
// Errors: IRRADIA_ERROR_ARGUMENT beyond the last message or for a buffer that is too small.
irradia_status irradia_context_validation_message(const irradia_context *context,
                                                  size_t *count,
                                                  size_t index,
                                                  char *buffer,
                                                  size_t capacity,
                                                  size_t *needed);

// How many device allocations of the context are alive, and their bytes; either place may be null. Without renderers there are none.
irradia_status irradia_context_allocations(const irradia_context *context,
                                           size_t *count,
                                           uint64_t *bytes);

// Makes a frame of a scene as it is now, and waits until it is done.
//
// What the scene, its lights and the camera leave unchanged since the renderer's last frame is not made again. The scene may belong to another context.
// `frame`: receives the frame, which irradia_frame_destroy() ends.
//
// Errors: IRRADIA_ERROR_ARGUMENT; IRRADIA_ERROR_SCENE for a camera that the scene has not; IRRADIA_ERROR_SETTINGS for methods that do not go together; IRRADIA_ERROR_DEVICE
// for what the device cannot do, a target that cannot be filled and a point that is not reached; IRRADIA_ERROR_MEMORY; IRRADIA_ERROR_DEVICE_LOST; IRRADIA_ERROR_CANCELLED;
// IRRADIA_ERROR_INTERNAL if a pixel were not a finite number of at least 0, which is a fault of the library's: its sentence names the pass.
// The renderer can go on after each but a lost device and a failure of the library. A frame that failed on its way may have moved on what is kept over frames;
// one that was refused, for an argument, a target or a point that is not reached, has not.
irradia_status irradia_render(irradia_renderer *renderer,
                              const irradia_scene *scene,
                              const irradia_frame_descriptor *descriptor,
                              irradia_frame **frame);

// Ends a frame. Null is allowed.
void irradia_frame_destroy(irradia_frame *frame);

// Copies the pixels of a slot. A slot that no method fills is black.
//
// Errors: IRRADIA_ERROR_ARGUMENT if the frame was not asked for the slot, or the rows do not fit; nothing is written then.
irradia_status irradia_frame_copy(const irradia_frame *frame,
                                  const irradia_pixels_descriptor *descriptor);

// Makes a renderer on a context's device. The context may be destroyed before it.
//
// `descriptor`: null for a descriptor of zeros.
// `renderer`: receives it; irradia_renderer_destroy() ends it.
//
// Errors: IRRADIA_ERROR_SETTINGS for names that do not exist, IRRADIA_ERROR_DEVICE if the device lacks what a method needs, IRRADIA_ERROR_MEMORY.
irradia_status irradia_renderer_create(const irradia_context *context,
                                       const irradia_renderer_descriptor *descriptor,
                                       irradia_renderer **renderer);

// Ends a renderer and frees what it holds on the device. Null is allowed.
void irradia_renderer_destroy(irradia_renderer *renderer);

// Sets one setting, as `--set key=value` on the command line does.
//
// `key`: "piece.name", such as "vpl.count". `value`: as text, such as "2000"; "null" for no limit.
//
// Errors: IRRADIA_ERROR_SETTINGS; the sentence says what the setting takes, or which there are.
irradia_status irradia_renderer_set(irradia_renderer *renderer, const char *key, const char *value);

// Chooses the method of a slot, as `--diffuse vpl` on the command line does.
//
// `slot`: "direct", "diffuse", "caustics" or "specular". `method`: a name, or "none"; one that does not exist is answered by the list.
irradia_status irradia_renderer_set_method(irradia_renderer *renderer,
                                           const char *slot,
                                           const char *method);

// Copies all settings as JSON, as `--json` of the command line has them.
//
// `buffer`: room for `capacity` bytes; null: only the length is asked for. `needed`: receives the text's length, its final zero included; may be null beside a
// buffer.
//
// Errors: IRRADIA_ERROR_ARGUMENT if the text does not fit; nothing is written then but `needed`.
irradia_status irradia_renderer_settings(const irradia_renderer *renderer,
                                         char *buffer,
                                         size_t capacity,
                                         size_t *needed);

// Replaces all settings by what irradia_renderer_settings() wrote, or a part of it with a technique: what is not given is that of the technique and the preset.
irradia_status irradia_renderer_set_settings(irradia_renderer *renderer,
                                             const char *json);

// One of the settings, by its place in the list: `index` from 0 until IRRADIA_ERROR_ARGUMENT says that there is no more.
//
// `option`: a descriptor whose size is set; it is filled.
irradia_status irradia_renderer_option(const irradia_renderer *renderer,
                                       size_t index,
                                       irradia_option_descriptor *option);

// Forgets what methods keep over frames, as before the first frame.
irradia_status irradia_renderer_reset_history(irradia_renderer *renderer);

// Forgets all results, so that the next frame makes everything anew; for timings of whole frames.
irradia_status irradia_renderer_invalidate(irradia_renderer *renderer);

// Stops the frame that another thread is having made, at the end of what the device is doing: between the samples of `path` and `sppm` and between the attempts of
// other frames, not within one. That call returns IRRADIA_ERROR_CANCELLED. If none is in progress, the next one is stopped.
//
// From any thread, while the renderer is alive.
irradia_status irradia_renderer_cancel(const irradia_renderer *renderer);

// Adds a light; a node must place it before it shines.
//
// `id`: receives its identifier; may be null.
//
// Errors: IRRADIA_ERROR_SCENE for an intensity or angles out of range.
irradia_status irradia_scene_add_light(irradia_scene *scene,
                                       const irradia_light_descriptor *descriptor,
                                       irradia_id *id);

// Replaces a light. One that stays the same costs nothing in the next frame.
irradia_status irradia_scene_set_light(irradia_scene *scene, irradia_id id, const irradia_light_descriptor *descriptor);

// Opens a scene by its name: a .gltf or .glb file's path, or a built-in scene such as "cornell-point".
//
// `context`, `scene`: as for irradia_scene_create(). `load`: null for the defaults.
//
// Errors: IRRADIA_ERROR_SCENE if there is none, or the file cannot be read or is not one. What was left out or changed is told as IRRADIA_KIND_WARNING.
irradia_status irradia_scene_open(const irradia_context *context,
                                  const char *name_or_path,
                                  const irradia_load_descriptor *load,
                                  irradia_scene **scene);

// Reads a scene from the bytes of a .gltf or .glb file, and the files that it names through the host.
//
// As irradia_scene_open(); `allow_outside_files` means nothing here: what a name leads to is the host's affair.
irradia_status irradia_scene_from_bytes(const irradia_context *context,
                                        const irradia_scene_bytes *source,
                                        const irradia_load_descriptor *load,
                                        irradia_scene **scene);

// Fills a descriptor, whose size is set, with the default material: white, rough, a dielectric of index 1.5, opaque.
irradia_status irradia_material_default(irradia_material_descriptor *descriptor);

// Adds a material.
//
// `id`: receives its identifier; may be null.
//
// Errors: IRRADIA_ERROR_SCENE for numbers out of range and textures that are not there.
irradia_status irradia_scene_add_material(irradia_scene *scene,
                                          const irradia_material_descriptor *descriptor,
                                          irradia_id *id);

// Fills a descriptor, whose size is set, with a material of the scene, to be changed and set again.
irradia_status irradia_scene_get_material(const irradia_scene *scene,
                                          irradia_id id,
                                          irradia_material_descriptor *descriptor);

// Replaces a material. One that stays the same costs nothing in the next frame. A name of null keeps the old one.
irradia_status irradia_scene_set_material(irradia_scene *scene,
                                          irradia_id id,
                                          const irradia_material_descriptor *descriptor);

// Adds a mesh; a node must place it before it is seen. Everything is copied.
//
// `id`: receives its identifier; may be null.
//
// Errors: IRRADIA_ERROR_ARGUMENT and IRRADIA_ERROR_SCENE for numbers that are not finite, indices beyond the vertices, materials that are not there.
irradia_status irradia_scene_add_mesh(irradia_scene *scene,
                                      const irradia_mesh_descriptor *descriptor,
                                      irradia_id *id);

// Replaces a mesh wherever it stands, for instance by one whose vertices moved. It has as many primitives as before; anything else may differ.
irradia_status irradia_scene_set_mesh(irradia_scene *scene,
                                      irradia_id id,
                                      const irradia_mesh_descriptor *descriptor);

// Adds a node, and so whatever it places.
//
// `id`: receives its identifier; may be null.
//
// Errors: IRRADIA_ERROR_SCENE if its parent or what it places is not there.
irradia_status irradia_scene_add_node(irradia_scene *scene, const irradia_node_descriptor *descriptor, irradia_id *id);

// Moves nodes, and with them all that hangs below them. What stays where it is costs nothing in the next frame; where render space has its zero, and how large
// the scene counts for settings that follow its size, stays as it was when it was first shown.
//
// `ids`: `count` nodes. `locals`: as many matrices of 16 numbers, as `local` of irradia_node_descriptor.
//
// Errors: IRRADIA_ERROR_ARGUMENT and IRRADIA_ERROR_SCENE; nothing moves then.
irradia_status irradia_scene_set_transforms(irradia_scene *scene,
                                            const irradia_id *ids,
                                            const double *locals,
                                            size_t count);

// Adds a texture, for materials to use.
//
// `id`: receives its identifier; may be null.
irradia_status irradia_scene_add_texture(irradia_scene *scene,
                                         const irradia_texture_descriptor *descriptor,
                                         irradia_id *id);

// Makes a scene without anything in it.
//
// `context`: whose threads and log the scene uses; null: the calling thread's process-wide ones, and no log. A scene can be shown on any context.
// `name`: what messages call it; null: "scene".
// `scene`: receives the scene, which irradia_scene_destroy() ends.
irradia_status irradia_scene_create(const irradia_context *context,
                                    const char *name,
                                    irradia_scene **scene);

// Ends a scene. What a renderer keeps of it stays on the device until the renderer shows another one or is destroyed. Null is allowed.
void irradia_scene_destroy(irradia_scene *scene);

// How many things of a kind the scene has: their identifiers are 1 to this number.
//
// `kind`: one of IRRADIA_KIND_….
irradia_status irradia_scene_count(const irradia_scene *scene, uint32_t kind, uint32_t *count);

// Copies the name of a thing, empty if it has none.
//
// `buffer`, `capacity`, `needed`: as for irradia_renderer_settings().
irradia_status irradia_scene_name(const irradia_scene *scene,
                                  uint32_t kind,
                                  irradia_id id,
                                  char *buffer,
                                  size_t capacity,
                                  size_t *needed);

// The first thing of a kind that goes by a name; 0 if none does, which is no error.
irradia_status irradia_scene_find(const irradia_scene *scene, uint32_t kind, const char *name, irradia_id *id);

// Sets the sky's radiance, alike from all directions.
//
// `radiance`: linear red, green, blue, W/(m² sr), finite and at least 0.
irradia_status irradia_scene_set_sky(irradia_scene *scene, const float *radiance);

// Puts everything that the scene's file animates where it is at a time.
//
// `seconds`: finite; before the first and after the last keyframe things stand still.
irradia_status irradia_scene_set_time(irradia_scene *scene, double seconds);

// Makes a buffer on a context's own device whose memory other processes can import.
//
// `byte_count`: at least 1; 16 a pixel.
// `buffer`: receives it; irradia_shared_buffer_destroy() ends it.
//
// Errors: IRRADIA_ERROR_DEVICE if the driver exports no memory, or the device is the host's, which shares what it likes; IRRADIA_ERROR_MEMORY.
irradia_status irradia_shared_buffer_create(const irradia_context *context,
                                            uint64_t byte_count,
                                            irradia_shared_buffer **buffer);

// Fills a descriptor, whose size is set.
irradia_status irradia_shared_buffer_get(const irradia_shared_buffer *buffer,
                                         irradia_shared_buffer_descriptor *descriptor);

// Exports its memory as a file descriptor, as often as it is asked.
//
// `fd`: receives a new one, which the caller closes, or hands to another process and closes; a Vulkan that imports one closes it.
irradia_status irradia_shared_buffer_export(const irradia_shared_buffer *buffer,
                                            int32_t *fd);

// Ends a shared buffer; memory that was imported elsewhere stays there. Null is allowed.
void irradia_shared_buffer_destroy(irradia_shared_buffer *buffer);

// One sentence on the last call of this thread that did not return IRRADIA_OK: what, where, what to do. Empty if there was none. UTF-8.
//
// The text stands until the next call of this thread fails; copy what must last longer. From any thread, each has its own.
const char *irradia_last_error(void);

// Fills a descriptor, whose size is set, with what the frame cost.
irradia_status irradia_frame_timings(const irradia_frame *frame, irradia_timings_descriptor *timings);

// Fills a descriptor, whose size is set, with one pass; `index` below `pass_count`, in the order in which passes run.
irradia_status irradia_frame_pass(const irradia_frame *frame, size_t index, irradia_pass_descriptor *pass);

// Fills a descriptor, whose size is set, with what one piece holds; `index` below `memory_count`.
irradia_status irradia_frame_memory(const irradia_frame *frame, size_t index, irradia_memory_descriptor *memory);

// Says what a device must be created with, before it is.
//
// `requirements`: receives them; irradia_requirements_destroy() ends them.
//
// Errors: IRRADIA_ERROR_DEVICE if the physical device cannot be used at all; the sentence says what it lacks.
irradia_status irradia_requirements_create(const irradia_instance_descriptor *instance,
                                           irradia_requirements **requirements);

// Fills a descriptor, whose size is set.
irradia_status irradia_requirements_get(const irradia_requirements *requirements,
                                        irradia_requirements_descriptor *descriptor);

// Ends requirements. Null is allowed.
void irradia_requirements_destroy(irradia_requirements *requirements);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* IRRADIA_H */
