// What the tone curves need to know of the whole image, found in three steps: blocks of pixels give their sum and maximum
// (tonemap/luminance), then their sum of logarithms (tonemap/log_luminance), and one group adds those up (tonemap/adaptation).

struct BlockLuminance {
    float sum;      // W/(m²·sr), luminance-weighted
    float maximum;
};

struct Adaptation {
    float log_average;  // exp(mean(ln L)) over the pixels with L > 10⁻³·mean(L), W/(m²·sr)
    float maximum;
};

// Pixels darker than this share of the mean, an empty background or a black shadow, do not count: a picture is exposed for what can be
// seen in it. Relative, so that a scene of twice the power looks the same.
const float DARK_SHARE_OF_MEAN = 1e-3;

// Σ ln L over the pixels that count, and their number.
struct LogSum {
    float sum;
    float count;
};

// Keeps logarithms and quotients of a black image finite.
const float SMALLEST_LUMINANCE = 1e-30;
