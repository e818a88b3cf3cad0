// What the tone curves need to know of the whole image, found in three steps: blocks of pixels give their sum and maximum
// (tonemap/luminance), then their sum of logarithms (tonemap/log_luminance), and one group adds those up (tonemap/adaptation).

struct BlockLuminance {
    float sum;      // W/(m²·sr), luminance-weighted
    float maximum;
};

struct Adaptation {
    float log_average;  // exp(mean(ln max(L, 10⁻⁴·mean(L)))), W/(m²·sr)
    float maximum;
};

// Relative to the mean: black pixels cannot pull the average to zero, and a scene of twice the power looks the same.
const float FLOOR_OF_MEAN = 1e-4;

// Keeps logarithms and quotients of a black image finite.
const float SMALLEST_LUMINANCE = 1e-30;
