/* A C program that uses every function once: host.c COMMAND OUTPUT.
 *
 *   all OUTPUT     everything in its right use; writes 64 x 48 pixels of three floats of `hybrid`'s image of cornell-point
 *   wrong          everything in its wrong use; nothing may happen but a status and a sentence
 *   scene          what needs no device
 *   memory COUNT   so many contexts, one after the other, each with a frame
 */
#include "irradia.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 64
#define HEIGHT 48

#define CHECK(condition)                                                                                 \
    do {                                                                                                 \
        if (!(condition)) {                                                                              \
            fprintf(stderr, "line %d: %s; last error: %s\n", __LINE__, #condition, irradia_last_error()); \
            exit(1);                                                                                     \
        }                                                                                                \
    } while (0)
#define OK(call) CHECK((call) == IRRADIA_OK)
#define FAILS(status, call) CHECK((call) == (status) && irradia_last_error()[0] != 0)

static void hear(void *user, uint32_t level, const char *message) {
    (void)level;
    if (message[0] != 0) ++*(unsigned *)user;
}

static uint32_t go_on(void *user, double done) {
    double *last = user;
    CHECK(done >= *last - 1e-12 && done <= 1.0);
    *last = done;
    return 0;
}

static uint32_t stop(void *user, double done) {
    (void)user;
    (void)done;
    return 1;
}

static uint32_t read_nothing(void *user, const char *uri, void *buffer, size_t capacity, size_t *length) {
    (void)uri;
    (void)buffer;
    (void)capacity;
    (void)length;
    ++*(unsigned *)user;
    return 1;
}

static const char triangle_bytes[36] = {0};

static uint32_t read_triangle(void *user, const char *uri, void *buffer, size_t capacity, size_t *length) {
    (void)user;
    if (strcmp(uri, "a file.bin") != 0) return 1;
    *length = sizeof triangle_bytes;
    if (buffer) memcpy(buffer, triangle_bytes, capacity < *length ? capacity : *length);
    return 0;
}

static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"name\":\"thing\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[0,0,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"a%20file.bin\"}]}";

/* A white floor of 2 m x 2 m under a lamp, all of the program's own memory, with strides. */
struct vertex {
    float position[3];
    unsigned char color[4];
    float texcoord[2];
    float normal[3];
};
static struct vertex floor_vertices[4] = {
    {{-1, 0, -1}, {255, 255, 255, 255}, {0, 0}, {0, 1, 0}},
    {{-1, 0, 1}, {255, 255, 255, 255}, {0, 1}, {0, 2, 0}},
    {{1, 0, 1}, {255, 255, 255, 255}, {1, 1}, {0, 1, 0}},
    {{1, 0, -1}, {255, 255, 255, 255}, {1, 0}, {0, 1, 0}},
};
static const uint16_t floor_indices[6] = {0, 1, 2, 0, 2, 3};

static irradia_primitive_descriptor floor_primitive(irradia_id material) {
    irradia_primitive_descriptor primitive = {.size = sizeof primitive};
    primitive.material = material;
    primitive.index_format = IRRADIA_INDEX_UINT16;
    primitive.indices = floor_indices;
    primitive.index_count = 6;
    primitive.vertex_count = 4;
    primitive.positions.data = floor_vertices[0].position;
    primitive.positions.stride = sizeof(struct vertex);
    primitive.colors.data = floor_vertices[0].color;
    primitive.colors.stride = sizeof(struct vertex);
    primitive.colors.format = IRRADIA_FORMAT_UNORM8;
    primitive.texcoords[0].data = floor_vertices[0].texcoord;
    primitive.texcoords[0].stride = sizeof(struct vertex);
    primitive.normals.data = floor_vertices[0].normal;
    primitive.normals.stride = sizeof(struct vertex);
    return primitive;
}

static double mean(irradia_frame *frame, uint32_t slot) {
    static float pixels[WIDTH * HEIGHT * 3];
    double sum = 0;
    size_t i;
    irradia_pixels_descriptor target = {.size = sizeof target};
    target.slot = slot;
    target.pixels = pixels;
    target.byte_count = sizeof pixels;
    OK(irradia_frame_copy(frame, &target));
    for (i = 0; i < WIDTH * HEIGHT * 3; ++i) {
        CHECK(isfinite(pixels[i]));
        sum += pixels[i];
    }
    return sum / (WIDTH * HEIGHT * 3);
}

static void check_built_scene(irradia_context *context) {
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_frame *frame = NULL;
    irradia_material_descriptor material = {.size = sizeof material};
    irradia_texture_descriptor texture = {.size = sizeof texture};
    irradia_light_descriptor light = {.size = sizeof light};
    irradia_node_descriptor node = {.size = sizeof node};
    irradia_mesh_descriptor mesh = {.size = sizeof mesh};
    irradia_camera_descriptor camera = {.size = sizeof camera};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_renderer_descriptor chosen = {.size = sizeof chosen};
    irradia_primitive_descriptor primitive;
    irradia_id material_id, texture_id, light_id, mesh_id, floor_id, lamp_id, camera_id, found;
    static const unsigned char white[4] = {255, 255, 255, 255};
    double lamp[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 2, 0, 1};
    const float sky[3] = {0, 0, 0};
    uint32_t count;
    double bright, moved, changed;

    OK(irradia_scene_create(context, "a floor", &scene));
    texture.width = texture.height = 1;
    texture.texels = white;
    texture.srgb = 1;
    OK(irradia_scene_add_texture(scene, &texture, &texture_id));
    OK(irradia_material_default(&material));
    CHECK(material.roughness == 1.0f && material.alpha_cutoff < 0);
    material.name = "white";
    material.specular = 0;
    material.base_color_texture.texture = texture_id;
    OK(irradia_scene_add_material(scene, &material, &material_id));
    primitive = floor_primitive(material_id);
    mesh.name = "floor";
    mesh.primitives = &primitive;
    mesh.primitive_count = 1;
    OK(irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    light.kind = IRRADIA_LIGHT_POINT;
    light.intensity[0] = light.intensity[1] = light.intensity[2] = 10;
    OK(irradia_scene_add_light(scene, &light, &light_id));
    node.name = "floor";
    node.mesh = mesh_id;
    OK(irradia_scene_add_node(scene, &node, &floor_id));
    node.name = "lamp";
    node.mesh = 0;
    node.light = light_id;
    memcpy(node.local, lamp, sizeof lamp);
    OK(irradia_scene_add_node(scene, &node, &lamp_id));
    OK(irradia_scene_set_sky(scene, sky));
    OK(irradia_scene_count(scene, IRRADIA_KIND_NODE, &count));
    CHECK(count == 2);
    OK(irradia_scene_find(scene, IRRADIA_KIND_NODE, "lamp", &found));
    CHECK(found == lamp_id);

    chosen.technique = "direct";
    OK(irradia_renderer_create(context, &chosen, &renderer));
    /* From above, at the floor alone: radiance at the middle is 1/pi * 10 W/sr / 4 m2. */
    memcpy(camera.world_from_camera, lamp, sizeof lamp);
    camera.projection = IRRADIA_PROJECTION_ORTHOGRAPHIC;
    camera.half_width = 0.04;
    camera.half_height = 0.03;
    camera.near = 0.1;
    camera.far = 10;
    wanted.width = WIDTH;
    wanted.height = HEIGHT;
    wanted.camera = &camera;
    wanted.slots = IRRADIA_SLOT_DIRECT;
    OK(irradia_render(renderer, scene, &wanted, &frame));
    bright = mean(frame, IRRADIA_SLOT_DIRECT);
    CHECK(fabs(bright - 10.0 / 4.0 / 3.14159265) < 2e-3);
    irradia_frame_destroy(frame);

    /* The same by a camera of the scene, where the lamp is. */
    memset(camera.world_from_camera, 0, sizeof camera.world_from_camera);
    OK(irradia_scene_add_camera(scene, "above", &camera, &camera_id));
    camera.half_width *= 2;
    camera.half_height *= 2;
    OK(irradia_scene_set_camera(scene, camera_id, "above", &camera));
    camera.half_width /= 2;
    camera.half_height /= 2;
    OK(irradia_scene_set_camera(scene, camera_id, "above", &camera));
    node.name = "eye";
    node.light = 0;
    node.parent = lamp_id;
    node.camera = camera_id;
    memset(node.local, 0, sizeof node.local);
    OK(irradia_scene_add_node(scene, &node, NULL));
    OK(irradia_scene_camera(scene, "above", &camera));
    CHECK(camera.world_from_camera[13] == 2 && camera.half_width == 0.04);
    wanted.camera = NULL;
    wanted.camera_name = "above";
    OK(irradia_render(renderer, scene, &wanted, &frame));
    CHECK(mean(frame, IRRADIA_SLOT_DIRECT) == bright);
    irradia_frame_destroy(frame);
    wanted.camera = &camera;
    wanted.camera_name = NULL;

    /* The lamp goes up to twice its height. */
    lamp[13] = 4;
    OK(irradia_scene_set_transforms(scene, &lamp_id, lamp, 1));
    OK(irradia_render(renderer, scene, &wanted, &frame));
    moved = mean(frame, IRRADIA_SLOT_DIRECT);
    CHECK(fabs(moved - bright / 4) < 2e-3 * bright);
    irradia_frame_destroy(frame);
    lamp[13] = 2;
    OK(irradia_scene_set_transforms(scene, &lamp_id, lamp, 1));

    /* The floor's vertices go down by 2 m, then half of it is absorbed, then the lamp is four times as strong. */
    for (count = 0; count < 4; ++count) floor_vertices[count].position[1] = -2;
    OK(irradia_scene_set_mesh(scene, mesh_id, &mesh));
    OK(irradia_render(renderer, scene, &wanted, &frame));
    changed = mean(frame, IRRADIA_SLOT_DIRECT);
    CHECK(fabs(changed - bright / 4) < 2e-3 * bright);
    irradia_frame_destroy(frame);
    OK(irradia_scene_get_material(scene, material_id, &material));
    CHECK(material.base_color_texture.texture == texture_id && material.base_color[0] == 1.0f);
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.5f;
    OK(irradia_scene_set_material(scene, material_id, &material));
    light.intensity[0] = light.intensity[1] = light.intensity[2] = 40;
    OK(irradia_scene_set_light(scene, light_id, &light));
    OK(irradia_render(renderer, scene, &wanted, &frame));
    changed = mean(frame, IRRADIA_SLOT_DIRECT);
    CHECK(fabs(changed - bright / 2) < 2e-3 * bright);
    irradia_frame_destroy(frame);
    for (count = 0; count < 4; ++count) floor_vertices[count].position[1] = 0;

    irradia_scene_destroy(scene);
    irradia_renderer_destroy(renderer);
}

/* Contexts' threads have names of their own. Those of rayon's that no context owns have the program's, as some of the driver's; of rayon's there would be as many
   as the variable says. */
static void check_threads(void) {
    unsigned unnamed = 0;
    const char *most = getenv("RAYON_NUM_THREADS");
    struct dirent *task;
    char path[300], own[64] = "", name[64];
    DIR *tasks;
    FILE *file;
    if (!most) return;
    tasks = opendir("/proc/self/task");
    file = fopen("/proc/self/comm", "r");
    CHECK(tasks && file && fgets(own, sizeof own, file));
    fclose(file);
    while ((task = readdir(tasks))) {
        snprintf(path, sizeof path, "/proc/self/task/%s/comm", task->d_name);
        file = fopen(path, "r");
        if (!file) continue;
        unnamed += fgets(name, sizeof name, file) && strcmp(name, own) == 0;
        fclose(file);
    }
    closedir(tasks);
    CHECK(unnamed < (unsigned)atoi(most));
}

static void check_all(const char *path) {
    irradia_context *context = NULL;
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_frame *frame = NULL;
    irradia_context_descriptor device = {.size = sizeof device};
    irradia_renderer_descriptor chosen = {.size = sizeof chosen};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_camera_descriptor camera = {.size = sizeof camera};
    irradia_option_descriptor option = {.size = sizeof option};
    irradia_timings_descriptor timings = {.size = sizeof timings};
    irradia_pass_descriptor pass = {.size = sizeof pass};
    irradia_memory_descriptor memory = {.size = sizeof memory};
    irradia_pixels_descriptor target = {.size = sizeof target};
    irradia_load_descriptor load = {.size = sizeof load};
    irradia_scene_bytes bytes = {.size = sizeof bytes};
    unsigned heard = 0;
    size_t count, needed, i;
    uint64_t held;
    uint32_t things;
    double done = 0, ran = 0;
    char *text;
    static float pixels[WIDTH * HEIGHT * 3];
    static unsigned char display[HEIGHT][WIDTH + 3][4];
    static uint16_t halves[WIDTH * HEIGHT * 4];
    FILE *file;

    CHECK(irradia_version() == IRRADIA_VERSION);
    device.validation = getenv("HOST_VALIDATION") ? IRRADIA_VALIDATION_SYNCHRONIZATION : IRRADIA_VALIDATION_OFF;
    device.log = hear;
    device.log_level = IRRADIA_LOG_DEBUG;
    device.log_user = &heard;
    OK(irradia_context_create(&device, &context));
    CHECK(irradia_context_device_name(context)[0] != 0);
    OK(irradia_context_allocations(context, &count, &held));
    CHECK(count == 0 && held == 0);

    OK(irradia_scene_open(context, "cornell-point", &load, &scene));
    OK(irradia_scene_count(scene, IRRADIA_KIND_MATERIAL, &things));
    CHECK(things > 0);
    OK(irradia_scene_name(scene, IRRADIA_KIND_MATERIAL, 1, NULL, 0, &needed));
    CHECK(needed >= 1);
    OK(irradia_scene_set_time(scene, 0));
    OK(irradia_scene_camera(scene, NULL, &camera));
    CHECK(camera.vertical_fov > 0);

    chosen.technique = "hybrid";
    chosen.preset = "default";
    OK(irradia_renderer_create(context, &chosen, &renderer));
    for (i = 0; irradia_renderer_option(renderer, i, &option) == IRRADIA_OK; ++i) {
        CHECK(option.key[0] && option.documentation[0] && option.takes[0] && option.kind >= IRRADIA_OPTION_INTEGER);
    }
    CHECK(i > 50);
    OK(irradia_renderer_settings(renderer, NULL, 0, &needed));
    text = malloc(needed);
    OK(irradia_renderer_settings(renderer, text, needed, NULL));
    CHECK(strlen(text) + 1 == needed && strstr(text, "\"technique\":\"hybrid\""));
    OK(irradia_renderer_set(renderer, "vpl.count", "100"));
    OK(irradia_renderer_set_method(renderer, "caustics", "none"));
    OK(irradia_renderer_set_settings(renderer, text));
    free(text);

    wanted.width = WIDTH;
    wanted.height = HEIGHT;
    wanted.camera = &camera;
    wanted.slots = IRRADIA_SLOT_IMAGE | IRRADIA_SLOT_DIFFUSE | IRRADIA_SLOT_DISPLAY;
    wanted.timing = IRRADIA_TIMING_PASSES;
    wanted.progress = go_on;
    wanted.progress_user = &done;
    OK(irradia_render(renderer, scene, &wanted, &frame));
    OK(irradia_frame_timings(frame, &timings));
    CHECK(timings.pass_count > 5 && timings.memory_count > 1 && timings.gpu_ms > 0);
    for (i = 0; i < timings.pass_count; ++i) {
        OK(irradia_frame_pass(frame, i, &pass));
        CHECK(pass.name[0] && (pass.skipped || pass.ms >= 0));
        ran += pass.ms > 0 ? pass.ms : 0;
    }
    CHECK(ran > 0);
    for (i = 0; i < timings.memory_count; ++i) {
        OK(irradia_frame_memory(frame, i, &memory));
        CHECK(memory.piece[0]);
    }
    target.slot = IRRADIA_SLOT_DISPLAY;
    target.format = IRRADIA_PIXELS_RGBA8;
    target.pixels = display;
    target.byte_count = sizeof display;
    target.row_stride = sizeof display[0];
    memset(display, 7, sizeof display);
    OK(irradia_frame_copy(frame, &target));
    CHECK(display[1][0][3] == 255 && display[0][WIDTH][0] == 7);
    target.slot = IRRADIA_SLOT_DIFFUSE;
    target.format = IRRADIA_PIXELS_RGBA16F;
    target.pixels = halves;
    target.byte_count = sizeof halves;
    target.row_stride = 0;
    OK(irradia_frame_copy(frame, &target));
    CHECK(halves[3] == 0x3c00);
    target.slot = IRRADIA_SLOT_IMAGE;
    target.format = IRRADIA_PIXELS_RGB32F;
    target.pixels = pixels;
    target.byte_count = sizeof pixels;
    OK(irradia_frame_copy(frame, &target));
    file = fopen(path, "wb");
    CHECK(file && fwrite(pixels, sizeof pixels, 1, file) == 1);
    fclose(file);
    irradia_frame_destroy(frame);

    /* Stopped by its progress, stopped from outside, and none the worse for it. */
    wanted.progress = stop;
    frame = (irradia_frame *)&wanted;
    FAILS(IRRADIA_ERROR_CANCELLED, irradia_render(renderer, scene, &wanted, &frame));
    CHECK(frame == NULL);
    wanted.progress = NULL;
    OK(irradia_renderer_cancel(renderer));
    FAILS(IRRADIA_ERROR_CANCELLED, irradia_render(renderer, scene, &wanted, &frame));
    for (i = 0; i < 2; ++i) {
        static float again[WIDTH * HEIGHT * 3];
        if (i == 1) {
            OK(irradia_renderer_reset_history(renderer));
            OK(irradia_renderer_invalidate(renderer));
        }
        OK(irradia_render(renderer, scene, &wanted, &frame));
        target.pixels = again;
        memset(again, 0, sizeof again);
        OK(irradia_frame_copy(frame, &target));
        CHECK(memcmp(again, pixels, sizeof pixels) == 0);
        irradia_frame_destroy(frame);
    }
    irradia_scene_destroy(scene);

    check_built_scene(context);

    bytes.name = "bytes";
    bytes.bytes = gltf;
    bytes.byte_count = sizeof gltf - 1;
    bytes.read = read_triangle;
    OK(irradia_scene_from_bytes(context, &bytes, NULL, &scene));
    OK(irradia_scene_count(scene, IRRADIA_KIND_WARNING, &things));
    irradia_scene_destroy(scene);
    bytes.read = read_nothing;
    bytes.read_user = &heard;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_from_bytes(context, &bytes, NULL, &scene));

    CHECK(heard > 0);
    OK(irradia_context_validation_message(context, &count, 0, NULL, 0, NULL));
    if (count > 0) {
        static char message[4096];
        irradia_context_validation_message(context, NULL, 0, message, sizeof message, &needed);
        fprintf(stderr, "%zu messages of the validation layer, the first: %s\n", count, message);
        exit(1);
    }
    check_threads();
    /* The renderer keeps the device. */
    irradia_context_destroy(context);
    irradia_renderer_destroy(renderer);
    irradia_frame_destroy(NULL);
    irradia_renderer_destroy(NULL);
    irradia_scene_destroy(NULL);
    irradia_context_destroy(NULL);
}

static void check_wrong(void) {
    irradia_context *context = NULL, *other = (irradia_context *)&context;
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_frame *frame = NULL;
    irradia_context_descriptor device = {.size = sizeof device};
    irradia_renderer_descriptor chosen = {.size = sizeof chosen};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_camera_descriptor camera = {.size = sizeof camera};
    irradia_material_descriptor material = {.size = sizeof material};
    irradia_light_descriptor light = {.size = sizeof light};
    irradia_node_descriptor node = {.size = sizeof node};
    irradia_mesh_descriptor mesh = {.size = sizeof mesh};
    irradia_texture_descriptor texture = {.size = sizeof texture};
    irradia_pixels_descriptor target = {.size = sizeof target};
    irradia_option_descriptor option = {.size = sizeof option};
    irradia_scene_bytes bytes = {.size = sizeof bytes};
    irradia_primitive_descriptor primitive;
    irradia_id id = 77, mesh_id, node_id;
    size_t needed = 0;
    uint32_t count;
    char little[4];
    float pixels[3 * 4];
    double matrix[16] = {0};
    struct {
        irradia_frame_descriptor known;
        uint64_t unknown;
    } newer;
    union {
        irradia_frame_descriptor whole;
        char bytes[sizeof(irradia_frame_descriptor)];
    } older;

    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_create(NULL, NULL));
    /* What could not be made is null, or 0, whatever stood there. */
    scene = (irradia_scene *)&context;
    renderer = (irradia_renderer *)&context;
    frame = (irradia_frame *)&context;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_open(NULL, NULL, NULL, &scene));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_create(NULL, NULL, &renderer));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(NULL, NULL, NULL, &frame));
    CHECK(scene == NULL && renderer == NULL && frame == NULL);
    scene = (irradia_scene *)&context;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_from_bytes(NULL, NULL, NULL, &scene));
    CHECK(scene == NULL);
    scene = (irradia_scene *)&context;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_create(NULL, "\xff", &scene));
    CHECK(scene == NULL);
    device.size = 3;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_create(&device, &other));
    CHECK(other == NULL);
    device.size = sizeof device;
    device.validation = 9;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_create(&device, &context));
    device.validation = 0;
    device.log_level = 9;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_create(&device, &context));
    device.log_level = 0;
    device.device = "a device that nobody has";
    FAILS(IRRADIA_ERROR_DEVICE, irradia_context_create(&device, &context));
    device.device = "\xff";
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_create(&device, &context));
    OK(irradia_context_create(NULL, &context));
    CHECK(irradia_context_device_name(NULL) == NULL);
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_allocations(NULL, &needed, NULL));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_context_validation_message(context, NULL, 0, little, 4, NULL));

    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_open(context, "no such scene", NULL, &scene));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_open(context, NULL, NULL, &scene));
    bytes.bytes = "{}";
    bytes.byte_count = 2;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_from_bytes(context, &bytes, NULL, &scene));
    bytes.bytes = NULL;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_from_bytes(context, &bytes, NULL, &scene));
    OK(irradia_scene_create(NULL, NULL, &scene));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_count(scene, 99, &count));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_count(NULL, IRRADIA_KIND_MESH, &count));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_name(scene, IRRADIA_KIND_MESH, 1, little, 4, NULL));
    OK(irradia_scene_find(scene, IRRADIA_KIND_MESH, "nothing", &id));
    CHECK(id == 0);
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_set_time(scene, NAN));
    pixels[0] = -1;
    pixels[1] = pixels[2] = 0;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_set_sky(scene, pixels));

    /* Materials, textures, lights */
    OK(irradia_material_default(&material));
    material.roughness = NAN;
    id = 77;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_material(scene, &material, &id));
    CHECK(id == 0);
    OK(irradia_material_default(&material));
    material.normal_texture.texture = 5;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_material(scene, &material, &id));
    OK(irradia_material_default(&material));
    material.double_sided = 2;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_material(scene, &material, &id));
    OK(irradia_material_default(&material));
    OK(irradia_scene_add_material(scene, &material, &id));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_get_material(scene, 2, &material));
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_set_material(scene, 2, &material));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_set_material(scene, 0, &material));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_texture(scene, &texture, NULL));
    texture.width = texture.height = 1;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_texture(scene, &texture, NULL));
    texture.texels = pixels;
    texture.wrap[1] = 3;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_texture(scene, &texture, NULL));
    texture.wrap[1] = 0;
    texture.row_stride = 3;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_texture(scene, &texture, NULL));
    light.reserved = 1;
    FAILS(IRRADIA_ERROR_VERSION, irradia_scene_add_light(scene, &light, NULL));
    light.reserved = 0;
    light.kind = 7;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_light(scene, &light, NULL));
    light.kind = IRRADIA_LIGHT_SPOT;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_light(scene, &light, NULL));
    light.kind = IRRADIA_LIGHT_POINT;
    light.intensity[0] = INFINITY;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_light(scene, &light, NULL));
    light.intensity[0] = 1;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_set_light(scene, 1, &light));

    /* Meshes and nodes */
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    mesh.primitives = &primitive;
    mesh.primitive_count = 1;
    primitive = floor_primitive(9);
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.vertex_count = 2;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.index_count = 5;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.index_format = 2;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.positions.format = IRRADIA_FORMAT_UNORM8;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.colors.reserved = 5;
    FAILS(IRRADIA_ERROR_VERSION, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    primitive.positions.stride = 4;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    primitive = floor_primitive(1);
    floor_vertices[2].texcoord[0] = NAN;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    floor_vertices[2].texcoord[0] = 1;
    floor_vertices[2].position[0] = INFINITY;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    floor_vertices[2].position[0] = 1;
    OK(irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_set_mesh(scene, 2, &mesh));
    camera.world_from_camera[0] = 1;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_camera(scene, NULL, &camera, &id));
    camera.world_from_camera[0] = 0;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_camera(scene, NULL, &camera, &id));
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_set_camera(scene, 1, NULL, &camera));
    node.camera = 1;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_node(scene, &node, NULL));
    node.camera = 0;
    node.mesh = 3;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_add_node(scene, &node, NULL));
    node.mesh = mesh_id;
    node.local[0] = NAN;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_node(scene, &node, NULL));
    node.local[0] = 1;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_add_node(scene, &node, NULL));
    node.local[0] = 0;
    OK(irradia_scene_add_node(scene, &node, &node_id));
    id = 4;
    FAILS(IRRADIA_ERROR_SCENE, irradia_scene_set_transforms(scene, &id, matrix, 1));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_set_transforms(scene, &node_id, NULL, 1));
    matrix[0] = 1e300;
    matrix[15] = 1;
    matrix[12] = NAN;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_set_transforms(scene, &node_id, matrix, 1));

    /* Renderers */
    chosen.technique = "no such technique";
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_create(context, &chosen, &renderer));
    chosen.technique = "direct";
    chosen.preset = "no such preset";
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_create(context, &chosen, &renderer));
    chosen.preset = NULL;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_create(NULL, &chosen, &renderer));
    OK(irradia_renderer_create(context, &chosen, &renderer));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set(renderer, "vpl.cuont", "3"));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set(renderer, "vpl.count", "-3"));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_set(renderer, NULL, "3"));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set_method(renderer, "diffuse", "magic"));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set_method(renderer, "indirect", "rsm"));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set_settings(renderer, "{"));
    FAILS(IRRADIA_ERROR_SETTINGS, irradia_renderer_set_settings(renderer, "{}"));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_settings(renderer, little, sizeof little, &needed));
    CHECK(needed > sizeof little);
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_settings(renderer, NULL, 0, NULL));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_option(renderer, 100000, &option));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_renderer_cancel(NULL));

    /* Frames */
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, NULL, &frame));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.width = wanted.height = 2;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(NULL, scene, &wanted, &frame));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, NULL, &wanted, &frame));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, NULL));
    wanted.slots = 1u << 20;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.slots = 0;
    wanted.timing = 2;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.timing = 0;
    wanted.tone_map = 3;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.tone_map = 0;
    wanted.time_step = -1;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.time_step = 0;
    wanted.camera_name = "no such camera";
    FAILS(IRRADIA_ERROR_SCENE, irradia_render(renderer, scene, &wanted, &frame));
    wanted.camera_name = NULL;
    wanted.camera = &camera;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    camera.vertical_fov = 1;
    camera.near = NAN;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    camera.near = 0.1;
    camera.reserved = 1;
    FAILS(IRRADIA_ERROR_VERSION, irradia_render(renderer, scene, &wanted, &frame));
    camera.reserved = 0;
    camera.projection = 5;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    camera.projection = 0;
    wanted.reserved = 1;
    FAILS(IRRADIA_ERROR_VERSION, irradia_render(renderer, scene, &wanted, &frame));
    wanted.reserved = 0;
    wanted.width = 1u << 30;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &wanted, &frame));
    wanted.width = 2;

    /* A newer program: served if it asks for nothing new. An older one: served. */
    memset(&newer, 0, sizeof newer);
    newer.known = wanted;
    newer.known.size = sizeof newer;
    OK(irradia_render(renderer, scene, &newer.known, &frame));
    irradia_frame_destroy(frame);
    newer.unknown = 1;
    FAILS(IRRADIA_ERROR_VERSION, irradia_render(renderer, scene, &newer.known, &frame));
    older.whole = wanted;
    older.whole.size = 8;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_render(renderer, scene, &older.whole, &frame));

    OK(irradia_render(renderer, scene, &wanted, &frame));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, NULL));
    target.slot = IRRADIA_SLOT_DIFFUSE;
    target.pixels = pixels;
    target.byte_count = sizeof pixels;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    target.slot = IRRADIA_SLOT_IMAGE;
    target.format = 17;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    target.format = IRRADIA_PIXELS_RGB8;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    target.format = IRRADIA_PIXELS_RGBA32F;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    target.format = IRRADIA_PIXELS_RGB32F;
    target.row_stride = 23;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    target.row_stride = SIZE_MAX - 3;
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_copy(frame, &target));
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_frame_pass(frame, 1000, (irradia_pass_descriptor *)&older));
    irradia_frame_destroy(frame);
    irradia_renderer_destroy(renderer);
    irradia_scene_destroy(scene);
    irradia_context_destroy(context);
}

/* What needs no device. */
static void check_scene(void) {
    irradia_scene *scene = NULL;
    irradia_scene_bytes bytes = {.size = sizeof bytes};
    irradia_material_descriptor material = {.size = sizeof material};
    irradia_light_descriptor light = {.size = sizeof light};
    irradia_node_descriptor node = {.size = sizeof node};
    irradia_mesh_descriptor mesh = {.size = sizeof mesh};
    irradia_camera_descriptor camera = {.size = sizeof camera};
    irradia_primitive_descriptor primitive;
    irradia_id material_id, light_id, mesh_id, node_id;
    double up[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1};
    char name[16];
    size_t needed;

    OK(irradia_scene_create(NULL, "by hand", &scene));
    OK(irradia_material_default(&material));
    material.name = "white";
    OK(irradia_scene_add_material(scene, &material, &material_id));
    primitive = floor_primitive(material_id);
    mesh.primitives = &primitive;
    mesh.primitive_count = 1;
    OK(irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    OK(irradia_scene_set_mesh(scene, mesh_id, &mesh));
    light.kind = IRRADIA_LIGHT_DIRECTIONAL;
    light.intensity[1] = 1;
    OK(irradia_scene_add_light(scene, &light, &light_id));
    node.mesh = mesh_id;
    node.light = light_id;
    OK(irradia_scene_add_node(scene, &node, &node_id));
    OK(irradia_scene_set_transforms(scene, &node_id, up, 1));
    OK(irradia_scene_camera(scene, NULL, &camera));
    OK(irradia_scene_name(scene, IRRADIA_KIND_MATERIAL, material_id, name, sizeof name, &needed));
    CHECK(strcmp(name, "white") == 0 && needed == 6);
    FAILS(IRRADIA_ERROR_ARGUMENT, irradia_scene_name(scene, IRRADIA_KIND_MATERIAL, material_id, name, 3, &needed));
    irradia_scene_destroy(scene);
    bytes.bytes = gltf;
    bytes.byte_count = sizeof gltf - 1;
    bytes.read = read_triangle;
    OK(irradia_scene_from_bytes(NULL, &bytes, NULL, &scene));
    irradia_scene_destroy(scene);
}

/* The sanitizer's, where there is one. */
size_t __sanitizer_get_current_allocated_bytes(void) __attribute__((weak));

/* What is held after contexts, as the sanitizer counts it. Beside other work some blocks go a little later (probably rayon's queues): so the most of the first ten is compared
 * with the least of the last ten, which a block that each context leaves would still be far above. */
static void check_memory(int rounds) {
    size_t most_at_first = 0, least_at_last = SIZE_MAX;
    int i;
    for (i = 0; i < rounds; ++i) {
        irradia_context *context = NULL;
        irradia_scene *scene = NULL;
        irradia_renderer *renderer = NULL;
        irradia_frame *frame = NULL;
        irradia_renderer_descriptor chosen = {.size = sizeof chosen};
        irradia_frame_descriptor wanted = {.size = sizeof wanted};
        chosen.technique = "direct";
        wanted.width = wanted.height = 8;
        OK(irradia_context_create(NULL, &context));
        OK(irradia_scene_open(context, "cornell-point", NULL, &scene));
        OK(irradia_renderer_create(context, &chosen, &renderer));
        OK(irradia_render(renderer, scene, &wanted, &frame));
        irradia_frame_destroy(frame);
        irradia_renderer_destroy(renderer);
        irradia_scene_destroy(scene);
        irradia_context_destroy(context);
        if (__sanitizer_get_current_allocated_bytes) {
            size_t held = __sanitizer_get_current_allocated_bytes();
            if (i < 10 && held > most_at_first) most_at_first = held;
            if (i >= rounds - 10 && held < least_at_last) least_at_last = held;
        }
    }
    if (__sanitizer_get_current_allocated_bytes) {
        printf("%zu bytes at most after each of 10 contexts, %zu at least after each of the last 10 of %d\n", most_at_first,
               least_at_last, rounds);
        CHECK(least_at_last <= most_at_first);
    }
}

int main(int count, char **arguments) {
    if (count == 3 && strcmp(arguments[1], "all") == 0) {
        check_all(arguments[2]);
    } else if (count == 2 && strcmp(arguments[1], "wrong") == 0) {
        check_wrong();
    } else if (count == 2 && strcmp(arguments[1], "scene") == 0) {
        check_scene();
    } else if (count == 3 && strcmp(arguments[1], "memory") == 0) {
        check_memory(atoi(arguments[2]));
    } else {
        fprintf(stderr, "host all OUTPUT | wrong | scene | memory COUNT\n");
        return 2;
    }
    return 0;
}
