//! Reads from SPIR-V what a pass must supply: bindings, push constants, specialisation constants, local size, and the
//! layout of every struct that crosses between host and shader.

use std::collections::BTreeMap;

use spirv::{Decoration, Dim, ExecutionMode, Op, StorageClass};

use super::words::{instructions, static_use};

/// A scalar, vector, matrix, array or struct in memory shared with the host.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Type {
    Float,
    Int,
    Uint,
    Array { element: Box<Type>, count: u32, stride: u32 },
    Struct(String),
}

/// A struct as the shader lays it out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Struct {
    pub(crate) name: String,
    pub(crate) fields: Vec<Field>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) offset: u32,
    pub(crate) ty: Type,
}

/// How many texels an image binding spans, as its shader type says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImageDim {
    D2,
    D2Array,
    D3,
    Cube,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum BindingKind {
    SampledImage(ImageDim),
    StorageImage { dim: ImageDim, reads: bool, writes: bool },
    TexelBuffer,
    Uniform(Type),
    Storage { element: Type, reads: bool, writes: bool },
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Binding {
    pub(crate) name: String,
    pub(crate) set: u32,
    pub(crate) binding: u32,
    pub(crate) kind: BindingKind,
    /// Of images and texel buffers: whether their texels are integers.
    pub(crate) integers: bool,
}

/// A specialisation constant with its default as raw bits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    pub(crate) name: String,
    pub(crate) id: u32,
    pub(crate) ty: Type,
    pub(crate) default: u32,
}

/// What one shader stage asks for.
#[derive(Debug, Default)]
pub(crate) struct Stage {
    /// What its entry point statically uses.
    pub(crate) bindings: Vec<Binding>,
    pub(crate) push: Option<Struct>,
    pub(crate) constants: Vec<Constant>,
    /// All that its source declares, used or not.
    pub(crate) declared_bindings: Vec<Binding>,
    pub(crate) declared_constants: Vec<Constant>,
    pub(crate) local_size: [u32; 3],
    pub(crate) structs: BTreeMap<String, Struct>,
}

#[derive(Clone, Debug)]
enum RawType {
    Int { signed: bool },
    Float,
    Vector { component: u32, count: u32 },
    Matrix { column: u32, count: u32 },
    Image { texel: u32, dim: Dim, arrayed: bool, sampled: u32 },
    SampledImage { image: u32 },
    Array { element: u32, length: u32 },
    RuntimeArray { element: u32 },
    Struct { members: Vec<u32> },
    Pointer { pointee: u32 },
}

/// The name of a block of push constants that belongs to one program. One of another name is a struct that programs share.
pub(crate) const OWN_PUSH: &str = "Push";

#[derive(Default)]
struct Module {
    names: BTreeMap<u32, String>,
    member_names: BTreeMap<(u32, u32), String>,
    decorations: BTreeMap<(u32, Decoration), u32>,
    member_decorations: BTreeMap<(u32, u32, Decoration), u32>,
    types: BTreeMap<u32, RawType>,
    constants: BTreeMap<u32, (u32, u32)>,
    specialised: Vec<u32>,
    variables: Vec<(u32, u32, StorageClass)>,
    local_size: [u32; 3],
    local_size_ids: Option<[u32; 3]>,
}

/// Reads one stage. Errors are sentences about the shader, without its file name.
pub(crate) fn reflect(words: &[u32]) -> Result<Stage, String> {
    let module = parse(words)?;
    let used = static_use(words)?;
    let mut stage = Stage { local_size: module.local_size, ..Stage::default() };
    if let Some(ids) = module.local_size_ids {
        stage.local_size = ids.map(|id| module.constants.get(&id).map_or(1, |constant| constant.1));
    }
    for &id in &module.specialised {
        let Some(&spec_id) = module.decorations.get(&(id, Decoration::SpecId)) else { continue };
        let (ty, default) = module.constants[&id];
        let ty = module.host_type(ty, &mut stage.structs)?;
        let constant = Constant { name: module.name(id)?, id: spec_id, ty, default };
        if used.contains(&id) {
            stage.constants.push(constant.clone());
        }
        stage.declared_constants.push(constant);
    }
    for &(id, pointer, class) in &module.variables {
        let Some(RawType::Pointer { pointee }) = module.types.get(&pointer) else { continue };
        match class {
            StorageClass::PushConstant => {
                let name = module.name(*pointee)?;
                let block = Struct { fields: module.struct_fields(*pointee, &mut stage.structs)?, name: name.clone() };
                if name != OWN_PUSH {
                    stage.structs.insert(name, block.clone());
                }
                stage.push = Some(block);
            }
            StorageClass::UniformConstant | StorageClass::Uniform | StorageClass::StorageBuffer => {
                let binding = module.binding(id, *pointee, class, &mut stage.structs)?;
                if used.contains(&id) {
                    stage.bindings.push(binding.clone());
                }
                stage.declared_bindings.push(binding);
            }
            _ => {}
        }
    }
    stage.bindings.sort_by_key(|binding| (binding.set, binding.binding));
    Ok(stage)
}

fn parse(words: &[u32]) -> Result<Module, String> {
    let mut module = Module { local_size: [1; 3], ..Module::default() };
    for (op, operands) in instructions(words)? {
        module.read(op, operands);
    }
    Ok(module)
}

fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|&byte| byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

impl Module {
    fn read(&mut self, op: Op, operands: &[u32]) {
        match op {
            Op::Name => drop(self.names.insert(operands[0], text(&operands[1..]))),
            Op::MemberName => drop(self.member_names.insert((operands[0], operands[1]), text(&operands[2..]))),
            Op::Decorate => {
                if let Some(decoration) = Decoration::from_u32(operands[1]) {
                    self.decorations.insert((operands[0], decoration), operands.get(2).copied().unwrap_or(0));
                }
            }
            Op::MemberDecorate => {
                if let Some(decoration) = Decoration::from_u32(operands[2]) {
                    self.member_decorations
                        .insert((operands[0], operands[1], decoration), operands.get(3).copied().unwrap_or(0));
                }
            }
            Op::ExecutionMode if operands[1] == ExecutionMode::LocalSize as u32 => {
                self.local_size = [operands[2], operands[3], operands[4]]
            }
            Op::ExecutionModeId if operands[1] == ExecutionMode::LocalSizeId as u32 => {
                self.local_size_ids = Some([operands[2], operands[3], operands[4]]);
            }
            Op::TypeInt => self.add_type(operands[0], RawType::Int { signed: operands[2] == 1 }),
            Op::TypeFloat => self.add_type(operands[0], RawType::Float),
            Op::TypeVector => {
                self.add_type(operands[0], RawType::Vector { component: operands[1], count: operands[2] })
            }
            Op::TypeMatrix => self.add_type(operands[0], RawType::Matrix { column: operands[1], count: operands[2] }),
            Op::TypeImage => {
                let dim = Dim::from_u32(operands[2]).unwrap_or(Dim::Dim2D);
                self.add_type(
                    operands[0],
                    RawType::Image { texel: operands[1], dim, arrayed: operands[4] == 1, sampled: operands[6] },
                );
            }
            Op::TypeSampledImage => self.add_type(operands[0], RawType::SampledImage { image: operands[1] }),
            Op::TypeArray => self.add_type(operands[0], RawType::Array { element: operands[1], length: operands[2] }),
            Op::TypeRuntimeArray => self.add_type(operands[0], RawType::RuntimeArray { element: operands[1] }),
            Op::TypeStruct => self.add_type(operands[0], RawType::Struct { members: operands[1..].to_vec() }),
            Op::TypePointer => self.add_type(operands[0], RawType::Pointer { pointee: operands[2] }),
            Op::Constant => drop(self.constants.insert(operands[1], (operands[0], operands[2]))),
            Op::SpecConstant => {
                self.constants.insert(operands[1], (operands[0], operands[2]));
                self.specialised.push(operands[1]);
            }
            Op::Variable => {
                if let Some(class) = StorageClass::from_u32(operands[2]) {
                    self.variables.push((operands[1], operands[0], class));
                }
            }
            _ => {}
        }
    }

    fn add_type(&mut self, id: u32, ty: RawType) {
        self.types.insert(id, ty);
    }

    fn name(&self, id: u32) -> Result<String, String> {
        self.names.get(&id).filter(|name| !name.is_empty()).cloned().ok_or_else(|| format!("%{id} has no name"))
    }

    fn has(&self, id: u32, decoration: Decoration) -> bool {
        self.decorations.contains_key(&(id, decoration))
    }

    fn is_integer(&self, id: u32) -> bool {
        matches!(self.types.get(&id), Some(RawType::Int { .. }))
    }

    fn binding(
        &self,
        id: u32,
        pointee: u32,
        class: StorageClass,
        structs: &mut BTreeMap<String, Struct>,
    ) -> Result<Binding, String> {
        let place = |decoration| self.decorations.get(&(id, decoration)).copied();
        let set = place(Decoration::DescriptorSet).unwrap_or(0);
        let reads = !self.has(id, Decoration::NonReadable);
        let writes = !self.has(id, Decoration::NonWritable);
        match &self.types[&pointee] {
            RawType::SampledImage { image } => {
                let RawType::Image { texel, dim, arrayed, .. } = self.types[image] else {
                    return Err("a sampler of no image".to_owned());
                };
                let kind = if dim == Dim::DimBuffer {
                    BindingKind::TexelBuffer
                } else {
                    BindingKind::SampledImage(image_dim(dim, arrayed)?)
                };
                Ok(Binding { integers: self.is_integer(texel), ..self.finish(id, self.name(id)?, set, kind)? })
            }
            RawType::Image { texel, dim, arrayed, sampled } => {
                let kind = match (dim, sampled) {
                    (Dim::DimBuffer, _) => BindingKind::TexelBuffer,
                    (_, 2) => BindingKind::StorageImage { dim: image_dim(*dim, *arrayed)?, reads, writes },
                    _ => {
                        return Err(format!(
                            "{} is a texture without a sampler; use sampler2D and its like",
                            self.name(id)?
                        ));
                    }
                };
                Ok(Binding { integers: self.is_integer(*texel), ..self.finish(id, self.name(id)?, set, kind)? })
            }
            RawType::Struct { members } => {
                let [member] = members[..] else {
                    return Err(format!(
                        "block {} must have exactly one member, a struct or an array",
                        self.name(pointee)?
                    ));
                };
                let name = self.member_names.get(&(pointee, 0)).cloned().ok_or("a block member has no name")?;
                let element = match self.types[&member] {
                    RawType::RuntimeArray { element } => element,
                    _ => member,
                };
                let ty = self.host_type(element, structs)?;
                let member_has = |decoration| self.member_decorations.contains_key(&(pointee, 0, decoration));
                let kind = if class == StorageClass::Uniform {
                    BindingKind::Uniform(ty)
                } else {
                    let reads = reads && !member_has(Decoration::NonReadable);
                    BindingKind::Storage { element: ty, reads, writes: writes && !member_has(Decoration::NonWritable) }
                };
                self.finish(id, name, set, kind)
            }
            _ => Err(format!("{} is of a kind that bindings do not have", self.name(id)?)),
        }
    }

    fn finish(&self, id: u32, name: String, set: u32, kind: BindingKind) -> Result<Binding, String> {
        let binding = self.decorations.get(&(id, Decoration::Binding)).copied();
        let binding = binding.ok_or_else(|| format!("{name} has no layout(binding = …)"))?;
        Ok(Binding { name, set, binding, kind, integers: false })
    }

    fn struct_fields(&self, id: u32, structs: &mut BTreeMap<String, Struct>) -> Result<Vec<Field>, String> {
        let RawType::Struct { members } = &self.types[&id] else { return Err("a block that is no struct".to_owned()) };
        let mut fields = Vec::new();
        for (index, &member) in (0..).zip(members) {
            let name = self.member_names.get(&(id, index)).cloned().ok_or("a struct member has no name")?;
            let offset = self.member_decorations.get(&(id, index, Decoration::Offset)).copied();
            let offset = offset.ok_or_else(|| format!("member {name} has no offset"))?;
            fields.push(Field { name, offset, ty: self.host_type(member, structs)? });
        }
        Ok(fields)
    }

    fn host_type(&self, id: u32, structs: &mut BTreeMap<String, Struct>) -> Result<Type, String> {
        Ok(match &self.types[&id] {
            RawType::Float => Type::Float,
            RawType::Int { signed: true } => Type::Int,
            RawType::Int { signed: false } => Type::Uint,
            RawType::Vector { component, count } => array(self.host_type(*component, structs)?, *count, 4),
            RawType::Matrix { column, count } => {
                let column = self.host_type(*column, structs)?;
                let stride = size_of(&column, structs);
                array(column, *count, stride)
            }
            RawType::Array { element, length } => {
                let count = self.constants.get(length).map_or(0, |constant| constant.1);
                let stride = self.decorations.get(&(id, Decoration::ArrayStride)).copied().unwrap_or(0);
                array(self.host_type(*element, structs)?, count, stride)
            }
            RawType::Struct { .. } => {
                let name = self.name(id)?;
                let fields = self.struct_fields(id, structs)?;
                structs.insert(name.clone(), Struct { name: name.clone(), fields });
                Type::Struct(name)
            }
            other => return Err(format!("a {other:?} cannot cross between host and shader")),
        })
    }
}

fn array(element: Type, count: u32, stride: u32) -> Type {
    Type::Array { element: Box::new(element), count, stride }
}

fn image_dim(dim: Dim, arrayed: bool) -> Result<ImageDim, String> {
    match (dim, arrayed) {
        (Dim::Dim2D, false) => Ok(ImageDim::D2),
        (Dim::Dim2D, true) => Ok(ImageDim::D2Array),
        (Dim::Dim3D, false) => Ok(ImageDim::D3),
        (Dim::DimCube, false) => Ok(ImageDim::Cube),
        _ => Err(format!("images of kind {dim:?} are not supported")),
    }
}

/// Bytes that a value takes with scalar block layout.
pub(crate) fn size_of(ty: &Type, structs: &BTreeMap<String, Struct>) -> u32 {
    match ty {
        Type::Float | Type::Int | Type::Uint => 4,
        Type::Array { count, stride, .. } => count * stride,
        Type::Struct(name) => {
            let last = structs[name].fields.iter().max_by_key(|field| field.offset);
            last.map_or(0, |field| field.offset + size_of(&field.ty, structs))
        }
    }
}
