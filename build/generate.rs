//! Writes the Rust side of every program: a struct with one named, typed field per binding, a nested one for each group that it
//! uses, the push constants, the structs shared with the host.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::groups::Group;
use super::needs::StageNeeds;
use super::reflect::{Binding, BindingKind, Constant, ImageDim, OWN_PUSH, Stage, Struct, Type, size_of};

/// A stage of a program, its SPIR-V, and the file in `OUT_DIR` that holds it.
pub(crate) struct CompiledStage {
    pub(crate) kind: &'static str,
    pub(crate) spirv_file: String,
    pub(crate) spirv: Vec<u8>,
    pub(crate) stage: Stage,
    pub(crate) needs: StageNeeds,
}

/// All stages of one program, merged.
pub(crate) struct Program {
    pub(crate) piece: String,
    pub(crate) pass: String,
    pub(crate) summary: String,
    pub(crate) stages: Vec<CompiledStage>,
}

/// The source of the generated module.
///
/// # Errors
/// Says which program contradicts itself or another one.
pub(crate) fn generate(programs: &[Program], groups: &[Group]) -> Result<String, String> {
    let mut structs: BTreeMap<String, Struct> = BTreeMap::new();
    for program in programs {
        for stage in &program.stages {
            for (name, found) in &stage.stage.structs {
                match structs.get(name) {
                    Some(known) if known != found => {
                        return Err(format!(
                            "struct {name} in glsl/{}/{} differs from the one of the same name elsewhere",
                            program.piece, program.pass
                        ));
                    }
                    Some(_) => {}
                    None => drop(structs.insert(name.clone(), found.clone())),
                }
            }
        }
    }
    let mut out = String::from("// Generated from the SPIR-V by build.rs.\n");
    out.push_str("/// Structs that host and shaders share, as the shaders lay them out.\npub mod types {\n");
    for shared in structs.values() {
        write_struct(&mut out, &shared.name, &shared.fields, &structs, "A struct shared with the shaders.")?;
    }
    out.push_str("}\n");
    write_groups(&mut out, groups);
    let all: Vec<String> =
        programs.iter().map(|it| format!("&{}::{}", it.piece, screaming(&camel(&it.pass)))).collect();
    writeln!(out, "/// All programs, in the order of their names.\npub(crate) static PROGRAMS: &[&crate::vulkan::program::Program] = &[{}];", all.join(", ")).ok();
    let mut pieces: BTreeMap<&str, Vec<&Program>> = BTreeMap::new();
    for program in programs {
        pieces.entry(&program.piece).or_default().push(program);
    }
    for (piece, programs) in pieces {
        writeln!(out, "/// The programs of `glsl/{piece}/`.\npub mod {piece} {{\n#[allow(unused_imports, reason = \"a piece may share nothing\")]\nuse super::{{groups, types}};\nuse crate::graph::bindings::*;\nuse crate::vulkan::program as vp;").ok();
        for program in programs {
            write_program(&mut out, program, groups, &structs)
                .map_err(|error| format!("glsl/{piece}/{}: {error}", program.pass))?;
        }
        out.push_str("}\n");
    }
    Ok(out)
}

/// The groups' structs: what a pass is given whole, and of which it takes what its program uses.
fn write_groups(out: &mut String, groups: &[Group]) {
    out.push_str(
        "/// Bindings that several programs share, a struct for each file of `glsl/groups/`.\npub mod groups {\n",
    );
    out.push_str("#[allow(unused_imports, reason = \"groups may share no struct\")]\nuse super::types;\n");
    out.push_str("#[allow(unused_imports, reason = \"there may be no group\")]\nuse crate::graph::bindings::*;\n");
    for group in groups {
        let name = camel(&group.name);
        writeln!(out, "/// {}\n#[derive(Clone, Debug)]\npub struct {name} {{", group.summary).ok();
        write_fields(out, group.members.iter(), &group.constants);
        out.push_str("}\n");
        let may_lack =
            |member: &Binding| matches!(member.kind, BindingKind::SampledImage(_) | BindingKind::TexelBuffer);
        if !group.members.is_empty() && group.members.iter().all(may_lack) {
            writeln!(
                out,
                "impl {name} {{\n/// Nothing is there; no pass reads any of it.\npub fn absent() -> {name} {{"
            )
            .ok();
            writeln!(out, "{name} {{").ok();
            for member in &group.members {
                writeln!(out, "{}: {}::absent(),", member.name, handle(&member.kind)).ok();
            }
            for constant in &group.constants {
                writeln!(out, "{}: {},", constant.name.to_lowercase(), default_of(constant)).ok();
            }
            out.push_str("}\n}\n}\n");
        }
    }
    out.push_str("}\n");
}

fn default_of(constant: &Constant) -> String {
    match constant.ty {
        Type::Float => format!("f32::from_bits({})", constant.default),
        Type::Int => format!("{}", constant.default.cast_signed()),
        _ => format!("{}", constant.default),
    }
}

fn write_fields<'a>(out: &mut String, bindings: impl Iterator<Item = &'a Binding>, constants: &[Constant]) {
    for field in bindings {
        writeln!(
            out,
            "/// Binding {} of set {}.\npub {}: {},",
            field.binding,
            field.set,
            field.name,
            handle(&field.kind)
        )
        .ok();
    }
    for constant in constants {
        let (name, ty) = (constant.name.to_lowercase(), rust_type(&constant.ty, ""));
        writeln!(out, "/// Specialisation constant {}.\npub {name}: {ty},", constant.id).ok();
    }
}

fn write_program(
    out: &mut String,
    program: &Program,
    groups: &[Group],
    structs: &BTreeMap<String, Struct>,
) -> Result<(), String> {
    let name = camel(&program.pass);
    let mut bindings: Vec<Binding> = Vec::new();
    let mut push: Option<Struct> = None;
    let mut constants: Vec<Constant> = Vec::new();
    let mut local_size = [1; 3];
    for CompiledStage { kind, stage, .. } in &program.stages {
        if *kind == "Compute" {
            local_size = stage.local_size;
        }
        for binding in &stage.bindings {
            match bindings.iter().find(|known| (known.set, known.binding) == (binding.set, binding.binding)) {
                Some(known) if known != binding => {
                    return Err(format!("{} and {} share a binding", known.name, binding.name));
                }
                Some(_) => {}
                None => bindings.push(binding.clone()),
            }
        }
        if let Some(block) = &stage.push {
            if push.as_ref().is_some_and(|known| known != block) {
                return Err("its stages declare different push constants".to_owned());
            }
            push = Some(block.clone());
        }
        constants.extend(
            stage
                .constants
                .iter()
                .filter(|constant| !constants.iter().any(|known| known.id == constant.id))
                .cloned()
                .collect::<Vec<_>>(),
        );
    }
    bindings.sort_by_key(|binding| (binding.set, binding.binding));
    let push_size = push.as_ref().map_or(0, |push| {
        push.fields.iter().map(|field| field.offset + size_of(&field.ty, structs)).max().unwrap_or(0)
    });
    if push_size > 128 {
        return Err(format!("its push constants take {push_size} bytes; every device offers 128"));
    }
    let push_type = push.as_ref().map(|push| match &*push.name {
        OWN_PUSH => format!("{name}Push"),
        shared => format!("types::{shared}"),
    });
    if let Some(push) = push.as_ref().filter(|push| push.name == OWN_PUSH) {
        write_struct(out, &format!("{name}Push"), &push.fields, structs, &format!("Push constants of [`{name}`]."))?;
    }
    write_table(out, program, &name, &bindings, &constants, local_size, push_size);
    let parts = Parts { groups, bindings: &bindings, constants: &constants, push: push_type.as_deref() };
    write_bindings(out, &name, &program.summary, 0, &parts)?;
    if bindings.iter().any(|binding| binding.set == 1) {
        let parts = Parts { groups: &[], constants: &[], push: None, ..parts };
        write_bindings(out, &format!("{name}Material"), "What a material binds for its draws.", 1, &parts)?;
    }
    Ok(())
}

fn write_table(
    out: &mut String,
    program: &Program,
    name: &str,
    bindings: &[Binding],
    constants: &[Constant],
    local_size: [u32; 3],
    push_size: u32,
) {
    writeln!(
        out,
        "pub(super) static {}: vp::Program = vp::Program {{ name: \"{}/{}\", stages: &[",
        screaming(name),
        program.piece,
        program.pass
    )
    .ok();
    for stage in &program.stages {
        writeln!(
            out,
            "vp::Stage {{ kind: vp::StageKind::{}, needs: {}, spirv: vp::Spirv(include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{}\"))) }},",
            stage.kind,
            stage_needs(stage),
            stage.spirv_file
        )
        .ok();
    }
    writeln!(out, "], bindings: &[").ok();
    for binding in bindings {
        let kind = match &binding.kind {
            BindingKind::SampledImage(dim) => format!("SampledImage(vp::ImageDim::{})", dim_name(*dim)),
            BindingKind::StorageImage { dim, .. } => format!("StorageImage(vp::ImageDim::{})", dim_name(*dim)),
            BindingKind::TexelBuffer => "TexelBuffer".to_owned(),
            BindingKind::Uniform(_) => "Uniform".to_owned(),
            BindingKind::Storage { .. } => "Storage".to_owned(),
        };
        writeln!(
            out,
            "vp::Binding {{ set: {}, binding: {}, kind: vp::BindingKind::{kind}, integers: {} }},",
            binding.set, binding.binding, binding.integers
        )
        .ok();
    }
    let constants: Vec<String> = constants.iter().map(|constant| constant.id.to_string()).collect();
    writeln!(out, "], push_size: {push_size}, constants: &[{}], local_size: {local_size:?} }};", constants.join(", "))
        .ok();
}

fn stage_needs(stage: &CompiledStage) -> String {
    let count =
        |counts: fn(&BindingKind) -> bool| stage.stage.bindings.iter().filter(|binding| counts(&binding.kind)).count();
    format!(
        "vp::StageNeeds {{ sampled_images: {}, samplers: {}, storage_images: {}, uniform_buffers: {}, storage_buffers: {}, \
         shared_bytes: {}, subgroup_operations: {}, clip_distances: {} }}",
        count(|kind| matches!(kind, BindingKind::SampledImage(_) | BindingKind::TexelBuffer)),
        count(|kind| matches!(kind, BindingKind::SampledImage(_))),
        count(|kind| matches!(kind, BindingKind::StorageImage { .. })),
        count(|kind| matches!(kind, BindingKind::Uniform(_))),
        count(|kind| matches!(kind, BindingKind::Storage { .. })),
        stage.needs.shared_bytes,
        stage.needs.subgroup_operations,
        stage.needs.clip_distances,
    )
}

/// What the struct of a program holds.
struct Parts<'a> {
    groups: &'a [Group],
    bindings: &'a [Binding],
    constants: &'a [Constant],
    /// The type of the push constants.
    push: Option<&'a str>,
}

impl Parts<'_> {
    /// The field that holds a binding of set 0 or a constant: its own, or one of its group's.
    fn place(&self, group: Option<&Group>, name: &str) -> String {
        group.map_or_else(|| format!("self.{name}"), |group| format!("self.{}.{name}", group.name))
    }

    fn group_of(&self, binding: &Binding) -> Option<&Group> {
        self.groups.iter().find(|group| group.owns(binding))
    }

    fn group_of_constant(&self, constant: &Constant) -> Option<&Group> {
        self.groups.iter().find(|group| group.owns_constant(constant))
    }

    /// The groups of which the program uses something.
    fn used_groups(&self) -> impl Iterator<Item = &Group> {
        let uses = |group: &&Group| {
            self.bindings.iter().any(|binding| group.owns(binding))
                || self.constants.iter().any(|constant| group.owns_constant(constant))
        };
        self.groups.iter().filter(uses)
    }
}

fn write_bindings(out: &mut String, name: &str, summary: &str, set: u32, parts: &Parts<'_>) -> Result<(), String> {
    let bindings: Vec<&Binding> = parts.bindings.iter().filter(|binding| binding.set == set).collect();
    let own = bindings.iter().copied().filter(|binding| parts.group_of(binding).is_none());
    let own_constants: Vec<Constant> =
        parts.constants.iter().filter(|constant| parts.group_of_constant(constant).is_none()).cloned().collect();
    if let Some(group) = parts.used_groups().find(|group| own.clone().any(|binding| binding.name == group.name)) {
        return Err(format!("it has both a binding and a group of the name {}", group.name));
    }
    writeln!(out, "/// {summary}\npub struct {name} {{").ok();
    for group in parts.used_groups() {
        writeln!(out, "/// `glsl/groups/{0}.glsl`.\npub {0}: groups::{1},", group.name, camel(&group.name)).ok();
    }
    write_fields(out, own, &own_constants);
    if let Some(push) = parts.push {
        writeln!(out, "/// Push constants.\npub push: {push},").ok();
    }
    let table = screaming(name.strip_suffix("Material").filter(|_| set == 1).unwrap_or(name));
    writeln!(
        out,
        "}}\nimpl BindingSet for {name} {{\nconst PROGRAM: &'static vp::Program = &{table};\nconst SET: u32 = {set};"
    )
    .ok();
    let visitor = if bindings.is_empty() { "_" } else { "visitor" };
    writeln!(out, "fn visit(&self, {visitor}: &mut dyn FnMut(u32, Option<Access>)) {{").ok();
    for binding in &bindings {
        let place = parts.place(parts.group_of(binding), &binding.name);
        writeln!(out, "visitor({}, {place}.access());", binding.binding).ok();
    }
    out.push_str("}\nfn push_bytes(&self) -> &[u8] {\n");
    out.push_str(if parts.push.is_some() { "bytemuck::bytes_of(&self.push)\n" } else { "&[]\n" });
    out.push_str("}\nfn constants(&self) -> Vec<u32> {\nvec![");
    for constant in parts.constants {
        let place = parts.place(parts.group_of_constant(constant), &constant.name.to_lowercase());
        let bits = match constant.ty {
            Type::Uint => "",
            Type::Float => ".to_bits()",
            _ => ".cast_unsigned()",
        };
        write!(out, "{place}{bits}, ").ok();
    }
    out.push_str("]\n}\n}\n");
    Ok(())
}

fn write_struct(
    out: &mut String,
    name: &str,
    fields: &[super::reflect::Field],
    structs: &BTreeMap<String, Struct>,
    summary: &str,
) -> Result<(), String> {
    writeln!(out, "/// {summary}\n#[repr(C)]\n#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]\npub struct {name} {{").ok();
    let mut end = 0;
    for field in fields {
        if field.offset != end {
            return Err(format!("{name}.{} does not follow the field before it: use scalar block layout", field.name));
        }
        end = field.offset + size_of(&field.ty, structs);
        let prefix = if name.ends_with("Push") { "types::" } else { "" };
        writeln!(out, "/// At byte {}.\npub {}: {},", field.offset, field.name, rust_type(&field.ty, prefix)).ok();
    }
    writeln!(out, "}}\nconst _: () = assert!(size_of::<{name}>() == {end});").ok();
    Ok(())
}

fn rust_type(ty: &Type, prefix: &str) -> String {
    match ty {
        Type::Float => "f32".to_owned(),
        Type::Int => "i32".to_owned(),
        Type::Uint => "u32".to_owned(),
        Type::Array { element, count, .. } => format!("[{}; {count}]", rust_type(element, prefix)),
        Type::Struct(name) => format!("{prefix}{name}"),
    }
}

fn handle(kind: &BindingKind) -> String {
    match kind {
        BindingKind::SampledImage(_) => "SampledImage".to_owned(),
        BindingKind::StorageImage { reads: true, writes: false, .. } => "ReadImage".to_owned(),
        BindingKind::StorageImage { reads: false, .. } => "WriteImage".to_owned(),
        BindingKind::StorageImage { .. } => "ReadWriteImage".to_owned(),
        BindingKind::TexelBuffer => "TexelBuffer".to_owned(),
        BindingKind::Uniform(ty) => format!("Uniform<{}>", rust_type(ty, "types::")),
        BindingKind::Storage { element, reads: true, writes: false } => {
            format!("ReadBuffer<{}>", rust_type(element, "types::"))
        }
        BindingKind::Storage { element, reads: false, .. } => format!("WriteBuffer<{}>", rust_type(element, "types::")),
        BindingKind::Storage { element, .. } => format!("ReadWriteBuffer<{}>", rust_type(element, "types::")),
    }
}

fn dim_name(dim: ImageDim) -> &'static str {
    match dim {
        ImageDim::D2 => "D2",
        ImageDim::D2Array => "D2Array",
        ImageDim::D3 => "D3",
        ImageDim::Cube => "Cube",
    }
}

fn camel(name: &str) -> String {
    let capital =
        |word: &str| word.chars().take(1).flat_map(char::to_uppercase).chain(word.chars().skip(1)).collect::<String>();
    name.split('_').map(capital).collect()
}

fn screaming(name: &str) -> String {
    let mut out = String::new();
    for (index, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && index > 0 {
            out.push('_');
        }
        out.extend(letter.to_uppercase());
    }
    out
}
