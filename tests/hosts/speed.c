/* What the border costs: speed. A mesh of a million triangles beside a copy of its bytes, a frame of 64 x 64 pixels beside what the engine itself takes of it, and what is
 * sent and built when 1,000 of 10,000 instances move, where surfaces are drawn and where rays meet them. */
#define _POSIX_C_SOURCE 199309L
#include "irradia.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ROUNDS 9
#define COLUMNS 1000
#define ROWS 500

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values) {
    qsort(values, ROUNDS, sizeof *values, ascending);
    return values[ROUNDS / 2];
}

static void ok(irradia_status status) {
    if (status != IRRADIA_OK) {
        fprintf(stderr, "%s\n", irradia_last_error());
        exit(1);
    }
}

#define PLACES 10000
#define MOVED 1000

/* Milliseconds and bytes of what frames send and build after some instances moved. */
static void move_instances(irradia_context *context, const char *direct) {
    static const float corners[9] = {0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0};
    static irradia_id nodes[PLACES];
    static double places[MOVED * 16];
    double times[ROUNDS];
    uint64_t bytes = 0;
    size_t i, round;
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_id material_id, mesh_id, light_id;
    irradia_material_descriptor material = {.size = sizeof material};
    irradia_primitive_descriptor primitive = {.size = sizeof primitive};
    irradia_mesh_descriptor mesh = {.size = sizeof mesh};
    irradia_light_descriptor light = {.size = sizeof light};
    irradia_node_descriptor node = {.size = sizeof node};
    irradia_renderer_descriptor chosen = {.size = sizeof chosen};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_camera_descriptor camera = {.size = sizeof camera};

    ok(irradia_scene_create(context, "many", &scene));
    ok(irradia_material_default(&material));
    ok(irradia_scene_add_material(scene, &material, &material_id));
    primitive.material = material_id;
    primitive.vertex_count = 3;
    primitive.positions.data = corners;
    mesh.primitives = &primitive;
    mesh.primitive_count = 1;
    ok(irradia_scene_add_mesh(scene, &mesh, &mesh_id));
    light.kind = IRRADIA_LIGHT_POINT;
    light.intensity[0] = light.intensity[1] = light.intensity[2] = 1000;
    ok(irradia_scene_add_light(scene, &light, &light_id));
    node.local[0] = node.local[5] = node.local[10] = node.local[15] = 1;
    for (i = 0; i < PLACES; ++i) {
        node.mesh = mesh_id;
        node.light = i ? 0 : light_id;
        node.local[12] = (double)(i % 100) - 50;
        node.local[13] = (double)(i / 100) - 50;
        node.local[14] = i ? 0 : 20;
        ok(irradia_scene_add_node(scene, &node, &nodes[i]));
    }
    chosen.technique = "direct";
    ok(irradia_renderer_create(context, &chosen, &renderer));
    ok(irradia_renderer_set_method(renderer, "direct", direct));
    camera.vertical_fov = 1;
    camera.near = 0.1;
    camera.world_from_camera[0] = camera.world_from_camera[5] = camera.world_from_camera[10] = camera.world_from_camera[15] = 1;
    camera.world_from_camera[14] = 90;
    wanted.width = wanted.height = 64;
    wanted.camera = &camera;
    for (round = 0; round <= ROUNDS; ++round) {
        irradia_frame *frame = NULL;
        irradia_timings_descriptor timings = {.size = sizeof timings};
        for (i = 0; i < MOVED; ++i) {
            double *place = places + 16 * i;
            memset(place, 0, 16 * sizeof *place);
            place[0] = place[5] = place[10] = place[15] = 1;
            place[12] = (double)((i + 1) % 100) - 50;
            place[13] = (double)((i + 1) / 100) - 50;
            place[14] = 0.01 * (double)round;
        }
        ok(irradia_scene_set_transforms(scene, nodes + 1, places, MOVED));
        ok(irradia_render(renderer, scene, &wanted, &frame));
        ok(irradia_frame_timings(frame, &timings));
        irradia_frame_destroy(frame);
        if (round > 0) times[round - 1] = timings.upload_ms;
        bytes = timings.upload_bytes;
    }
    printf("1,000 of 10,000 instances moved, direct light by %s: %.3f ms to send and to build, %lu bytes\n", direct, median(times),
           (unsigned long)bytes);
    irradia_renderer_destroy(renderer);
    irradia_scene_destroy(scene);
}

int main(void) {
    const size_t vertex_count = (COLUMNS + 1) * (ROWS + 1), index_count = 6 * COLUMNS * ROWS;
    float *positions = malloc(vertex_count * 12), *normals = malloc(vertex_count * 12);
    uint32_t *indices = malloc(index_count * 4), *index = indices;
    double copies[ROUNDS], meshes[ROUNDS], calls[ROUNDS], inside[ROUNDS];
    size_t i, x, y;
    irradia_context *context = NULL;
    irradia_scene *scene = NULL;
    irradia_renderer *renderer = NULL;
    irradia_material_descriptor material = {.size = sizeof material};
    irradia_primitive_descriptor primitive = {.size = sizeof primitive};
    irradia_mesh_descriptor mesh = {.size = sizeof mesh};
    irradia_renderer_descriptor chosen = {.size = sizeof chosen};
    irradia_frame_descriptor wanted = {.size = sizeof wanted};
    irradia_pixels_descriptor target = {.size = sizeof target};
    static float pixels[64 * 64 * 3];
    volatile char sink = 0; /* a copy that nobody reads would not be made */

    for (i = 0; i < vertex_count; ++i) {
        positions[3 * i] = (float)(i % (COLUMNS + 1));
        positions[3 * i + 1] = 0;
        positions[3 * i + 2] = (float)(i / (COLUMNS + 1));
        normals[3 * i] = normals[3 * i + 2] = 0;
        normals[3 * i + 1] = 1;
    }
    for (y = 0; y < ROWS; ++y) {
        for (x = 0; x < COLUMNS; ++x) {
            const uint32_t corner = (uint32_t)(y * (COLUMNS + 1) + x), below = corner + COLUMNS + 1;
            *index++ = corner, *index++ = below, *index++ = corner + 1;
            *index++ = corner + 1, *index++ = below, *index++ = below + 1;
        }
    }
    ok(irradia_context_create(NULL, &context));
    ok(irradia_material_default(&material));
    primitive.material = 1;
    primitive.indices = indices;
    primitive.index_count = index_count;
    primitive.vertex_count = vertex_count;
    primitive.positions.data = positions;
    primitive.normals.data = normals;
    mesh.primitives = &primitive;
    mesh.primitive_count = 1;
    for (i = 0; i < ROUNDS; ++i) {
        double start = now();
        char *copy = malloc(vertex_count * 24 + index_count * 4);
        memcpy(copy, positions, vertex_count * 12);
        memcpy(copy + vertex_count * 12, normals, vertex_count * 12);
        memcpy(copy + vertex_count * 24, indices, index_count * 4);
        copies[i] = now() - start;
        sink += copy[i * 4096];
        free(copy);
        ok(irradia_scene_create(context, NULL, &scene));
        ok(irradia_scene_add_material(scene, &material, NULL));
        start = now();
        ok(irradia_scene_add_mesh(scene, &mesh, NULL));
        meshes[i] = now() - start;
        irradia_scene_destroy(scene);
    }
    printf("a million triangles: %.2f ms, a copy of their bytes: %.2f ms, ratio %.2f\n", median(meshes), median(copies),
           median(meshes) / median(copies));

    chosen.technique = "direct";
    ok(irradia_scene_open(context, "cornell-point", NULL, &scene));
    ok(irradia_renderer_create(context, &chosen, &renderer));
    wanted.width = wanted.height = 64;
    target.slot = IRRADIA_SLOT_IMAGE;
    target.pixels = pixels;
    target.byte_count = sizeof pixels;
    for (i = 0; i < ROUNDS + 2; ++i) {
        irradia_frame *frame = NULL;
        irradia_timings_descriptor timings = {.size = sizeof timings};
        const double start = now();
        double end;
        ok(irradia_renderer_invalidate(renderer));
        ok(irradia_render(renderer, scene, &wanted, &frame));
        ok(irradia_frame_copy(frame, &target));
        end = now();
        ok(irradia_frame_timings(frame, &timings));
        irradia_frame_destroy(frame);
        if (i >= 2) {
            calls[i - 2] = end - start;
            inside[i - 2] = timings.host_ms;
        }
    }
    printf("a frame of 64x64: %.3f ms of the calls, %.3f ms inside of the engine, ratio %.4f\n", median(calls), median(inside),
           median(calls) / median(inside));
    irradia_renderer_destroy(renderer);
    irradia_scene_destroy(scene);
    move_instances(context, "shadow-map");
    move_instances(context, "traced");
    irradia_context_destroy(context);
    free(positions);
    free(normals);
    free(indices);
    return 0;
}
