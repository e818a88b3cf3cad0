//! What the build script makes of shaders: the Rust side of a sound program, and errors that name the file for others.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

#[path = "../build.rs"]
#[allow(dead_code, reason = "its main is cargo's to call")]
mod build_script;

use build_script::limits::{Exception, Limit};

/// A folder of shaders and one for what is made of them; gone with the test.
struct Tree(PathBuf);

impl Tree {
    fn new(files: &[(&str, &str)]) -> Tree {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("irradia-shader-build-{}-{number}", std::process::id()));
        fs::create_dir_all(folder.join("out")).expect("a temporary folder");
        for (name, source) in files {
            let path = folder.join("glsl").join(name);
            fs::create_dir_all(path.parent().expect("it lies in a folder")).expect("a temporary folder");
            fs::write(path, source).expect("a temporary file");
        }
        Tree(folder)
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

/// The generated module, or what the build script complains about.
fn build(files: &[(&str, &str)]) -> Result<String, String> {
    build_with(files, &[])
}

/// The same with exceptions to the limits.
fn build_with(files: &[(&str, &str)], exceptions: &[Exception]) -> Result<String, String> {
    let tree = Tree::new(files);
    let out = tree.0.join("out");
    build_script::build(&tree.0.join("glsl"), &out, exceptions)?;
    Ok(fs::read_to_string(Path::new(&out).join("shaders.rs")).expect("it was made"))
}

/// The error of shaders that must not build.
fn complaint(files: &[(&str, &str)]) -> String {
    let error = build(files).expect_err("it must not build");
    println!("{error}");
    error
}

const HEAD: &str =
    "#version 460\n#extension GL_EXT_scalar_block_layout : require\nlayout(scalar) uniform;\nlayout(scalar) buffer;\n";

fn compute(body: &str) -> String {
    format!("{HEAD}layout(local_size_x = 8, local_size_y = 4) in;\n{body}")
}

#[test]
fn a_program_becomes_a_struct_with_a_typed_field_for_each_binding() {
    let source = compute(
        "// Sums things up. More is said here.
        struct Item { vec3 position; uint kind; mat3x4 place; ivec2 cells[5]; };
        layout(constant_id = 3) const float SHARE = 0.5;
        layout(constant_id = 4) const uint MODE = 1u;
        layout(set = 0, binding = 0) uniform View { Item view; };
        layout(set = 0, binding = 1) readonly buffer Items { Item items[]; };
        layout(set = 0, binding = 2) writeonly buffer Sums { float sums[]; };
        layout(set = 0, binding = 3) buffer Counters { uint counters[]; };
        layout(set = 0, binding = 4) uniform sampler2D color;
        layout(set = 0, binding = 5) uniform usamplerBuffer list;
        layout(set = 0, binding = 6, r32f) readonly uniform image2D before;
        layout(set = 0, binding = 7, r32f) writeonly uniform image2D after;
        layout(set = 0, binding = 8, r32ui) uniform uimage3D grid;
        layout(push_constant, scalar) uniform Push { vec2 low; uint item_count; } push;
        void main() {
            float sum = SHARE * float(MODE) + push.low.x + float(push.item_count) + view.position.x + items[0].position.y;
            sum += texelFetch(color, ivec2(0), 0).x + float(texelFetch(list, 0).x) + imageLoad(before, ivec2(0)).x;
            sums[0] = sum + float(atomicAdd(counters[0], 1u));
            imageStore(after, ivec2(0), vec4(sum));
            imageAtomicAdd(grid, ivec3(0), 1u);
        }",
    );
    let generated = build(&[("piece/sum_up.comp", &source)]).expect("a sound program");
    for line in [
        "pub mod piece {",
        "/// Sums things up.",
        "pub struct SumUp {",
        "pub view: Uniform<types::Item>,",
        "pub items: ReadBuffer<types::Item>,",
        "pub sums: WriteBuffer<f32>,",
        "pub counters: ReadWriteBuffer<u32>,",
        "pub color: SampledImage,",
        "pub list: TexelBuffer,",
        "pub before: ReadImage,",
        "pub after: WriteImage,",
        "pub grid: ReadWriteImage,",
        "pub share: f32,",
        "pub mode: u32,",
        "pub push: SumUpPush,",
        "pub struct SumUpPush {",
        "pub low: [f32; 2],",
        "pub item_count: u32,",
        "pub struct Item {",
        "pub place: [[f32; 4]; 3],",
        "pub cells: [[i32; 2]; 5],",
        "const _: () = assert!(size_of::<Item>() == 104);",
        "const _: () = assert!(size_of::<SumUpPush>() == 12);",
        "kind: vp::BindingKind::StorageImage(vp::ImageDim::D3)",
    ] {
        assert!(generated.contains(line), "no line {line:?} in\n{generated}");
    }
    assert!(generated.contains("local_size: [8, 4, 1]"), "{generated}");
    assert!(generated.contains("push_size: 12, constants: &[3, 4]"), "{generated}");
}

#[test]
fn stages_of_one_stem_become_one_program() {
    let vertex = format!(
        "{HEAD}layout(set = 0, binding = 0) uniform A {{ vec4 corner; }};\nvoid main() {{ gl_Position = corner; }}"
    );
    let fragment = format!(
        "{HEAD}layout(set = 0, binding = 0) uniform A {{ vec4 corner; }};\nlayout(set = 0, binding = 1) uniform sampler2DArray layers;\nlayout(location = 0) out vec4 color;\nvoid main() {{ color = corner + texelFetch(layers, ivec3(0), 0); }}"
    );
    let generated = build(&[("piece/draw.vert", &vertex), ("piece/draw.frag", &fragment)]).expect("a sound program");
    assert_eq!(generated.matches("pub struct Draw {").count(), 1, "{generated}");
    assert_eq!(generated.matches("pub corner: Uniform<[f32; 4]>,").count(), 1, "{generated}");
    let (vertex, fragment) = (generated.find("StageKind::Vertex"), generated.find("StageKind::Fragment"));
    assert!(vertex.is_some() && vertex < fragment, "{generated}");
    assert!(generated.contains("SampledImage(vp::ImageDim::D2Array)"), "{generated}");
}

#[test]
fn an_error_in_a_shader_names_file_and_line() {
    let source = compute("void main() {\n    float x = 1.0;\n    x = undeclared + 1.0;\n}");
    let error = complaint(&[("piece/broken.comp", &source)]);
    assert!(error.contains("piece/broken.comp:8") && error.contains("undeclared"), "{error}");
}

#[test]
fn an_error_in_an_include_names_the_include_and_its_line() {
    let source = compute("#extension GL_GOOGLE_include_directive : require\n#include \"lib/sum.glsl\"\nvoid main() {}");
    let error = complaint(&[("piece/user.comp", &source), ("lib/sum.glsl", "float sum() {\n    return nothing;\n}\n")]);
    assert!(error.contains("lib/sum.glsl:2"), "{error}");
    let error = complaint(&[("piece/user.comp", &source)]);
    assert!(error.contains("piece/user.comp") && error.contains("lib/sum.glsl"), "{error}");
}

#[test]
fn a_binding_without_its_number_is_refused() {
    for body in [
        "layout(set = 0) buffer Sums { float sums[]; };\nvoid main() { sums[0] = 1.0; }",
        "layout(set = 0) uniform sampler2D color;\nlayout(set = 0, binding = 1) buffer Sums { float sums[]; };\nvoid main() { sums[0] = texelFetch(color, ivec2(0), 0).x; }",
    ] {
        let error = complaint(&[("piece/unbound.comp", &compute(body))]);
        assert!(error.contains("piece/unbound.comp:6") && error.contains("binding"), "{error}");
    }
}

#[test]
fn stages_that_disagree_on_a_binding_are_refused() {
    let vertex = format!(
        "{HEAD}layout(set = 0, binding = 0) uniform A {{ vec4 corner; }};\nvoid main() {{ gl_Position = corner; }}"
    );
    let fragment = format!(
        "{HEAD}layout(set = 0, binding = 0) uniform B {{ vec4 tint; }};\nlayout(location = 0) out vec4 color;\nvoid main() {{ color = tint; }}"
    );
    let error = complaint(&[("piece/draw.vert", &vertex), ("piece/draw.frag", &fragment)]);
    for word in ["glsl/piece/draw", "corner", "tint"] {
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn a_struct_that_differs_between_shaders_is_refused() {
    let shader = |fields: &str| {
        compute(&format!(
            "struct Item {{ {fields} }};\nlayout(set = 0, binding = 0) buffer Items {{ Item items[]; }};\nvoid main() {{ items[0] = items[1]; }}"
        ))
    };
    let files =
        [("a/one.comp", shader("vec3 position; uint kind;")), ("b/two.comp", shader("vec4 position; uint kind;"))];
    let error = complaint(&files.each_ref().map(|(name, source)| (*name, source.as_str())));
    assert!(error.contains("struct Item") && error.contains("glsl/b/two"), "{error}");
}

#[test]
fn push_constants_of_another_name_are_one_type_for_all_programs() {
    let block = "layout(push_constant, scalar) uniform Reach { vec3 center; uint count; } push;";
    let body = "layout(set = 0, binding = 0) buffer Sums { float sums[]; };
        void main() { sums[0] = push.center.x * float(push.count); }";
    let shader = compute(&format!("{block}\n{body}"));
    let generated = build(&[("a/one.comp", &shader), ("b/two.comp", &shader)]).expect("sound programs");
    assert_eq!(generated.matches("pub struct Reach {").count(), 1, "{generated}");
    assert_eq!(generated.matches("pub push: types::Reach,").count(), 2, "{generated}");
    let other = shader.replace("vec3 center", "vec3 middle").replace("push.center", "push.middle");
    let error = complaint(&[("a/one.comp", &shader), ("b/two.comp", &other)]);
    assert!(error.contains("struct Reach") && error.contains("glsl/b/two"), "{error}");
}

#[test]
fn stages_with_different_push_constants_are_refused() {
    let vertex = format!(
        "{HEAD}layout(push_constant, scalar) uniform Push {{ vec4 corner; }} push;\nvoid main() {{ gl_Position = push.corner; }}"
    );
    let fragment = format!(
        "{HEAD}layout(push_constant, scalar) uniform Push {{ vec3 tint; }} push;\nlayout(location = 0) out vec4 color;\nvoid main() {{ color = push.tint.xyzz; }}"
    );
    let error = complaint(&[("piece/draw.vert", &vertex), ("piece/draw.frag", &fragment)]);
    assert!(error.contains("glsl/piece/draw") && error.contains("push constants"), "{error}");
}

#[test]
fn layouts_that_rust_does_not_share_are_refused() {
    let padded = "#version 460\nlayout(local_size_x = 1) in;\nstruct Item { vec3 position; vec3 normal; };\nlayout(std430, set = 0, binding = 0) buffer Items { Item items[]; };\nvoid main() { items[0] = items[1]; }";
    let error = complaint(&[("piece/padded.comp", padded)]);
    assert!(error.contains("Item.normal") && error.contains("scalar"), "{error}");
    let long = compute(
        "layout(push_constant, scalar) uniform Push { vec4 rows[9]; } push;\nlayout(set = 0, binding = 0) buffer Sums { vec4 sums[]; };\nvoid main() { sums[0] = push.rows[8]; }",
    );
    let error = complaint(&[("piece/long.comp", &long)]);
    assert!(error.contains("glsl/piece/long") && error.contains("128"), "{error}");
}

const RAYS: &str = "// What rays meet. More is said here.\n// group: bindings 32 to 39, constants 32 to 33\n\
    layout(constant_id = 32) const uint MASKS = 0u;\nlayout(constant_id = 33) const uint COLORS = 1u;\n\
    layout(set = 0, binding = 32) uniform usamplerBuffer nodes;\nlayout(set = 0, binding = 33) uniform samplerBuffer triangles;\n";
const LIGHTS: &str = "// group: bindings 40 to 43\nlayout(set = 0, binding = 40) uniform usamplerBuffer lights;\n";

/// A program that includes `groups` and does `work` into `sums[0]`.
fn with_groups(groups: &[&str], work: &str) -> String {
    let includes: String = groups.iter().map(|group| format!("#include \"groups/{group}.glsl\"\n")).collect();
    compute(&format!("{includes}layout(set = 0, binding = 0) buffer Sums {{ float sums[]; }};\n{work}"))
}

#[test]
fn a_group_becomes_a_struct_of_which_a_program_takes_what_it_uses() {
    // `triangles` is named in a function that nobody calls, COLORS in one that main calls through another.
    let user = with_groups(
        &["rays", "lights"],
        "float unused() { return texelFetch(triangles, 0).x; }
        float color() { return COLORS != 0u ? 1.0 : 0.5; }
        float node(int place) { return float(texelFetch(nodes, place).x) * color(); }
        void main() { sums[0] = node(3); }",
    );
    let generated = build(&[("groups/rays.glsl", RAYS), ("groups/lights.glsl", LIGHTS), ("piece/user.comp", &user)])
        .expect("a sound program");
    for line in [
        "/// What rays meet.\n#[derive(Clone, Debug)]\npub struct Rays {",
        "pub nodes: TexelBuffer,",
        "pub triangles: TexelBuffer,",
        "pub masks: u32,",
        "pub fn absent() -> Rays {",
        "pub rays: groups::Rays,",
        "visitor(32, self.rays.nodes.access());",
        "vec![self.rays.colors, ]",
        "constants: &[33]",
        "kind: vp::BindingKind::TexelBuffer, integers: true",
    ] {
        assert!(generated.contains(line), "no line {line:?} in\n{generated}");
    }
    for word in ["visitor(33", "groups::Lights", "self.rays.masks"] {
        assert!(!generated.contains(word), "{word} in\n{generated}");
    }
}

#[test]
fn what_no_group_declares_and_no_program_uses_is_not_bound() {
    let source = compute(
        "layout(constant_id = 0) const uint SIDE = 2u;
        layout(constant_id = 1) const uint IDLE = 2u;
        layout(set = 0, binding = 0) buffer Sums { float sums[]; };
        layout(set = 0, binding = 1) uniform sampler2D idle;
        const uint AREA = SIDE * SIDE;
        shared float parts[AREA];
        void main() { parts[0] = 1.0; sums[0] = parts[0]; }",
    );
    let generated = build(&[("piece/user.comp", &source)]).expect("a sound program");
    assert!(generated.contains("constants: &[0]") && generated.contains("pub side: u32"), "{generated}");
    assert!(!generated.contains("idle"), "{generated}");
}

#[test]
fn the_spirv_lacks_what_is_not_used() {
    let work = "void main() { sums[0] = float(texelFetch(nodes, 0).x); }";
    let tree = Tree::new(&[("groups/rays.glsl", RAYS), ("piece/user.comp", &with_groups(&["rays"], work))]);
    let out = tree.0.join("out");
    build_script::build(&tree.0.join("glsl"), &out, &[]).expect("a sound program");
    let bytes = fs::read(out.join("piece.user.comp.spv")).expect("it was made");
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().expect("4"))).collect();
    let stage = build_script::reflect::reflect(&words).expect("it is whole");
    let names: Vec<&str> = stage.declared_bindings.iter().map(|binding| binding.name.as_str()).collect();
    assert_eq!(names, ["sums", "nodes"]);
}

#[test]
fn groups_keep_to_their_numbers() {
    let user = with_groups(&["rays"], "void main() { sums[0] = float(texelFetch(nodes, 0).x); }");
    let refused = |group: &str, source: &str, words: &[&str]| {
        let error = complaint(&[("groups/rays.glsl", RAYS), (group, source), ("piece/user.comp", &user)]);
        for word in words {
            assert!(error.contains(word), "no {word} in {error}");
        }
    };
    refused(
        "groups/lights.glsl",
        "// group: bindings 39 to 43\nlayout(set = 0, binding = 40) uniform usamplerBuffer lights;\n",
        &["glsl/groups/lights.glsl", "glsl/groups/rays.glsl", "bindings"],
    );
    refused(
        "groups/lights.glsl",
        "// group: bindings 40 to 43, constants 33 to 34\nlayout(set = 0, binding = 40) uniform usamplerBuffer lights;\n",
        &["glsl/groups/lights.glsl", "glsl/groups/rays.glsl", "constants"],
    );
    refused(
        "groups/lights.glsl",
        "// group: bindings 40 to 43\nlayout(set = 0, binding = 38) uniform usamplerBuffer lights;\n",
        &["glsl/groups/lights.glsl", "lights", "38", "range"],
    );
    refused(
        "groups/lights.glsl",
        "layout(set = 0, binding = 40) uniform usamplerBuffer lights;\n",
        &["glsl/groups/lights.glsl", "// group:"],
    );
}

#[test]
fn a_member_is_declared_once() {
    let again = "// group: bindings 40 to 43\nlayout(set = 0, binding = 40) uniform usamplerBuffer nodes;\n";
    let error = complaint(&[("groups/rays.glsl", RAYS), ("groups/again.glsl", again)]);
    for word in ["nodes", "glsl/groups/rays.glsl", "glsl/groups/again.glsl"] {
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn a_program_declares_nothing_with_a_groups_numbers() {
    let files = |declared: &str| {
        let work = format!("{declared}\nvoid main() {{ sums[0] = 1.0; }}");
        with_groups(&[], &work)
    };
    for (declared, name, number) in [
        ("layout(set = 0, binding = 35) uniform samplerBuffer own;", "own", "35"),
        ("layout(set = 0, binding = 32) uniform usamplerBuffer nodes;", "nodes", "32"),
        ("layout(constant_id = 33) const uint OWN = 0u;", "OWN", "33"),
    ] {
        let error = complaint(&[("groups/rays.glsl", RAYS), ("piece/user.comp", &files(declared))]);
        for word in ["glsl/piece/user", "glsl/groups/rays.glsl", name, number] {
            assert!(error.contains(word), "no {word} in {error}");
        }
    }
}

/// A program that uses so many bindings of one kind, and a storage buffer besides.
fn many(kind: &str, count: usize) -> String {
    let (mut declared, mut sum) = (String::new(), String::from("1.0"));
    for number in 1..=count {
        let place = format!("layout(set = 0, binding = {number}");
        declared += &match kind {
            "sampled" if number % 2 == 0 => format!("{place}) uniform samplerBuffer m{number};\n"),
            "sampled" => format!("{place}) uniform sampler2D m{number};\n"),
            "image" => format!("{place}, r32f) readonly uniform image2D m{number};\n"),
            "uniform" => format!("{place}) uniform B{number} {{ vec4 m{number}; }};\n"),
            "storage" => format!("{place}) buffer B{number} {{ float m{number}[]; }};\n"),
            _ => format!("layout(set = {number}, binding = 0) buffer B{number} {{ float m{number}[]; }};\n"),
        };
        sum += &match kind {
            "sampled" if number % 2 == 0 => format!(" + texelFetch(m{number}, 0).x"),
            "sampled" => format!(" + texelFetch(m{number}, ivec2(0), 0).x"),
            "image" => format!(" + imageLoad(m{number}, ivec2(0)).x"),
            "uniform" => format!(" + m{number}.x"),
            _ => format!(" + m{number}[0]"),
        };
    }
    compute(&format!(
        "layout(set = 0, binding = 0) buffer Sums {{ float sums[]; }};\n{declared}void main() {{ sums[0] = {sum}; }}"
    ))
}

#[test]
fn what_not_every_device_binds_is_refused() {
    for (kind, most, count, what) in [
        ("sampled", 16, "17", "sampled images and texel buffers"),
        ("image", 4, "5", "storage images"),
        ("uniform", 12, "13", "uniform buffers"),
        // Sums is one too.
        ("storage", 3, "5", "storage buffers"),
        ("sets", 2, "4", "descriptor sets"),
    ] {
        build(&[("piece/user.comp", &many(kind, most))]).expect("as much as every device offers");
        let error = complaint(&[("piece/user.comp", &many(kind, most + 1))]);
        for word in ["glsl/piece/user", count, what] {
            assert!(error.contains(word), "no {word} in {error}");
        }
    }
}

#[test]
fn exceptions_are_listed_with_their_number_and_go_when_they_are_none() {
    let exception = |program, count| Exception { program, limit: Limit::StorageBuffers, count, reason: "a test" };
    let files = |count: usize| many("storage", count);
    let build = |count: usize, exceptions: &[Exception]| build_with(&[("piece/user.comp", &files(count))], exceptions);
    build(5, &[exception("piece/user", 6)]).expect("it is listed");
    for (count, exceptions, word) in [
        (5, [exception("piece/user", 7)], "lists 7"),
        (3, [exception("piece/user", 5)], "for nothing"),
        (3, [exception("piece/gone", 5)], "does not exist"),
    ] {
        let error = build(count, &exceptions).expect_err("it must not build");
        println!("{error}");
        assert!(error.contains(exceptions[0].program) && error.contains(word), "{error}");
    }
}
