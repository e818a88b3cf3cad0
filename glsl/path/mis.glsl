// How the ways of finding a path are weighted: the balance heuristic (Veach & Guibas 1995) over
//
//   hit    the camera's path runs into the emitter z_{k+1}                p_hit     (1/sr at z_k)
//   next   the light is sampled from z_k (next-event estimation)          p_next    (1/sr at z_k)
//   light  a light's path reaches z_1 and is connected to the camera      X·p_next  (only where z_1 scatters diffusely, k ≥ 2)
//
// with the camera's path z_1 … z_k. All densities are those of labelled paths (lobes.glsl), without Russian roulette. X is carried
// along as the ratio C of the densities of what both walks made so far,
//
//   C_k = Π_{i=2}^{k−1} p(z_i → z_{i−1}) / (c(z_1) Π_{i=1}^{k−1} p(z_i → z_{i+1}))        p in 1/m² at the vertex that it leads to
//   X = C_k · p(z_k → z_{k−1}) · N p(light → z_k)
//
// c(z_1): camera rays per m² of surface and sample of every pixel; N: light paths for a sample of all pixels. A light's path y_1 … y_k
// carries the inverse D in the same way, with the factor 1 + p_hit/p_next at y_1 and p(y_j → y_{j−1}) at the later ones.
#ifndef PATH_MIS
#define PATH_MIS

// Light paths: N of them for every sample of all pixels. Some go wherever the light goes, others are sent to what gathers light
// (src/frame/rays/targets.rs).
struct LightPaths {
    float count;     // N
    float anywhere;  // the share of the former
    float targeted;  // the share of the latter, times the factor that target densities lack
};

// p(light → z) in 1/m² of the surface at z, from that of paths that go anywhere and the target density there. Nothing is sent where
// no path would go otherwise.
float light_path_density(LightPaths paths, float anywhere, float target_density) {
    return anywhere > 0.0 ? paths.anywhere * anywhere + paths.targeted * target_density : 0.0;
}

// Where camera rays go: one ray for every sample of a pixel.
struct CameraRays {
    float density;      // perspective: pixels per sr on the axis; orthographic: pixels per m² across the view
    float orthographic; // 1 or 0
};

// c(z): camera rays per m² of a surface at `position`, for one sample of every pixel.
float camera_rays_per_area(CameraRays rays, vec3 camera_position, vec3 forward, vec3 position, vec3 geometric_normal) {
    if (rays.orthographic != 0.0) {
        return rays.density * abs(dot(geometric_normal, forward));
    }
    vec3 way = position - camera_position;
    float distance2 = max(dot(way, way), 1e-30);
    vec3 direction = way * inversesqrt(distance2);
    float axial = max(dot(direction, forward), 1e-6);
    return rays.density * abs(dot(geometric_normal, direction)) / (distance2 * axial * axial * axial);
}

#endif
