// The sums before each of a row's numbers, by one group: before(i) = Σ_{j<i} term(j). Each invocation sums a run of consecutive numbers, the
// group scans its sums (Hillis & Steele 1986), each invocation walks its run again. Fixed order, whatever a subgroup's size is: the same bits
// every time.
//
// The including shader has declared its local size, along x alone, and defines
//   SCAN_TYPE                                       what is summed: uint, float, vec4
//   SCAN_TYPE scan_term(uint index)                 the row's number
//   void scan_store(uint index, SCAN_TYPE before)   takes the sum before it
#ifndef LIB_PREFIX_SCAN
#define LIB_PREFIX_SCAN

shared SCAN_TYPE scan_sums[gl_WorkGroupSize.x];

uvec2 scan_run(uint count) {
    uint run = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    uint first = min(gl_LocalInvocationIndex * run, count);
    return uvec2(first, min(first + run, count));
}

// The sum before the invocation's run of `count` numbers. All invocations of the group must come here, and a barrier lie between two calls.
SCAN_TYPE scan_sum_before_run(uint count) {
    uint self = gl_LocalInvocationIndex;
    uvec2 run = scan_run(count);
    SCAN_TYPE sum = SCAN_TYPE(0);
    for (uint index = run.x; index < run.y; ++index) {
        sum += scan_term(index);
    }
    scan_sums[self] = sum;
    barrier();
    [[dont_unroll]] for (uint stride = 1u; stride < gl_WorkGroupSize.x; stride *= 2u) {
        SCAN_TYPE lower = self >= stride ? scan_sums[self - stride] : SCAN_TYPE(0);
        barrier();
        scan_sums[self] += lower;
        barrier();
    }
    return self > 0u ? scan_sums[self - 1u] : SCAN_TYPE(0);
}

// Of all numbers; to be read after scan_sum_before_run().
SCAN_TYPE scan_total() {
    return scan_sums[gl_WorkGroupSize.x - 1u];
}

void scan_store_run(uint count, SCAN_TYPE before) {
    uvec2 run = scan_run(count);
    for (uint index = run.x; index < run.y; ++index) {
        scan_store(index, before);
        before += scan_term(index);
    }
}

// Stores the sums before `count` numbers, and behind them the sum of all.
void scan(uint count) {
    scan_store_run(count, scan_sum_before_run(count));
    if (gl_LocalInvocationIndex == 0u) {
        scan_store(count, scan_total());
    }
}

#endif
