//! What kernels share to build lists: the prefix scan of a group (glsl/lib/prefix_scan.glsl) and the append of a subgroup (glsl/lib/append.glsl).

use super::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::shaders::selftest::{List, ListPush, Scan, ScanPush};

#[test]
fn a_scan_leaves_the_sum_before_each_number() {
    let session = Session::open();
    let mut store = session.store();
    for count in [1_u32, 63, 64, 65, 128, 1000, 4097] {
        let numbers: Vec<u32> = (0..count).map(|index| index.wrapping_mul(2_654_435_761) % 1000).collect();
        let mut graph = Graph::new(&mut store);
        let given = graph.upload("numbers", &numbers, Dependence::GEOMETRY);
        let sums = graph.buffer::<u32>("sums", count as usize + 1);
        let pass = Scan { numbers: given.read(), sums_before: sums.write(), push: ScanPush { number_count: count } };
        graph.pass("test/scan", pass).groups([1, 1, 1]);
        let read_back = graph.read_back_buffer(sums);
        let found: Vec<u32> = bytemuck::pod_collect_to_vec(&graph.run(Timing::Frame).expect("a frame").take(read_back));
        let mut before = 0;
        for (index, number) in numbers.iter().enumerate() {
            assert_eq!(found[index], before, "before number {index} of {count}");
            before += number;
        }
        assert_eq!(found[numbers.len()], before, "all {count}");
    }
}

/// Whatever the subgroups' size is.
#[test]
fn an_append_lists_each_invocation_that_wants_it_once() {
    let session = Session::open();
    let mut store = session.store();
    for wanted in [0, 1, 0x8000_0000, 0x0F0F_1234, u32::MAX] {
        let count = 10_007_u32;
        let mut graph = Graph::new(&mut store);
        let list = graph.buffer::<u32>("list", count as usize + 2);
        graph.fill_buffer("test/clear-list", list, 0);
        let pass = List { list: list.read_write(), push: ListPush { wanted, count } };
        graph.pass("test/list", pass).threads([count, 1, 1]);
        let read_back = graph.read_back_buffer(list);
        let found: Vec<u32> = bytemuck::pod_collect_to_vec(&graph.run(Timing::Frame).expect("a frame").take(read_back));
        let expected: Vec<u32> = (0..count).filter(|number| wanted >> (number % 32) & 1 != 0).collect();
        let length = expected.len();
        assert_eq!(found[..2], [length as u32; 2], "{wanted:#x}");
        let mut listed = found[2..2 + length].to_vec();
        listed.sort_unstable();
        assert_eq!(listed, expected, "{wanted:#x}");
    }
}
