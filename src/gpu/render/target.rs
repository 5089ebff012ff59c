//! A tile on the device: textures that samples are drawn into, and the pipeline that draws.

use super::look::{Look, Paint, colour};
use super::{Facet, SAMPLES};
use crate::error::Result;
use crate::gpu::Device;

/// Rows of a texture that is copied into a buffer begin at multiples of so many bytes.
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// Colours of a heat map that are told apart.
const COLOURS: usize = 256;

/// What the shader is told: `Look` of render.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    origin: [f32; 2],
    size: [f32; 2],
    paint: u32,
    log: u32,
    least: f32,
    most: f32,
    line: f32,
    samples: f32,
    spare: [u32; 2],
    colours: [[f32; 4]; COLOURS],
}

/// Facets on the device.
pub(super) struct Batch {
    group: wgpu::BindGroup,
    vertices: u32,
}

/// What tiles are drawn into, one after another.
pub(super) struct Target<'a> {
    device: &'a Device,
    uniform: Uniform,
    buffer: wgpu::Buffer,
    pipeline: wgpu::RenderPipeline,
    colour: wgpu::Texture,
    depth: wgpu::Texture,
    /// Where samples are read from.
    staging: wgpu::Buffer,
    background: [u8; 3],
    size: [u32; 2],
}

/// Samples along an axis that the device can draw at once.
pub(super) fn texture_max(device: &Device) -> u32 {
    device.device.limits().max_texture_dimension_2d
}

impl<'a> Target<'a> {
    /// Makes room for tiles of `size` pixels.
    pub(super) fn new(device: &'a Device, look: &Look, size: [u32; 2]) -> Result<Self> {
        let uniform = uniform(look, size);
        let samples = size.map(|side| side * SAMPLES);
        let (pipeline, colour, depth) = device.guarded(wgpu::ErrorFilter::Validation, || {
            let colour = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
            let depth = wgpu::TextureUsages::RENDER_ATTACHMENT;
            (
                pipeline(&device.device),
                texture(&device.device, samples, COLOUR, colour),
                texture(&device.device, samples, DEPTH, depth),
            )
        })?;
        let make = |size: u64, usage| buffer(&device.device, size, usage);
        let bytes = u64::from(row(size)) * u64::from(samples[1]);
        let (buffer, staging) = device.guarded(wgpu::ErrorFilter::OutOfMemory, || {
            (
                make(size_of::<Uniform>() as u64, wgpu::BufferUsages::UNIFORM),
                make(bytes, wgpu::BufferUsages::MAP_READ),
            )
        })?;
        let background = look.background;
        Ok(Self { device, uniform, buffer, pipeline, colour, depth, staging, background, size })
    }

    /// Pixels of a tile.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Bytes from one row of samples to the next.
    pub(super) fn row(&self) -> usize {
        row(self.size) as usize
    }

    /// Takes facets to the device, as many at once as a binding has room for.
    pub(super) fn upload(&self, facets: &[Facet]) -> Result<Vec<Batch>> {
        let most = (self.device.words_max() * 4 / size_of::<Facet>()).max(1);
        let batch = |facets: &[Facet]| {
            let bytes: &[u8] = bytemuck::cast_slice(facets);
            let storage = self.device.guarded(wgpu::ErrorFilter::OutOfMemory, || {
                buffer(&self.device.device, bytes.len() as u64, wgpu::BufferUsages::STORAGE)
            })?;
            self.device.queue.write_buffer(&storage, 0, bytes);
            self.device.guarded(wgpu::ErrorFilter::Validation, || {
                let group = self.device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout: &self.pipeline.get_bind_group_layout(0),
                    entries: &[
                        wgpu::BindGroupEntry {
                            binding: 0,
                            resource: self.buffer.as_entire_binding(),
                        },
                        wgpu::BindGroupEntry { binding: 1, resource: storage.as_entire_binding() },
                    ],
                });
                Batch { group, vertices: 3 * facets.len() as u32 }
            })
        };
        facets.chunks(most).map(batch).collect()
    }

    /// Draws the tile that begins at the pixel `at`: rows of samples, four bytes each.
    pub(super) fn draw(&self, batches: &[Batch], at: [u32; 2]) -> Result<Vec<u8>> {
        let uniform = Uniform { origin: at.map(|k| (k * SAMPLES) as f32), ..self.uniform };
        self.device.queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(&uniform));
        self.device.guarded(wgpu::ErrorFilter::Validation, || {
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            self.pass(&mut encoder, batches);
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row(self.size)),
                rows_per_image: None,
            };
            encoder.copy_texture_to_buffer(
                self.colour.as_image_copy(),
                wgpu::TexelCopyBufferInfo { buffer: &self.staging, layout },
                self.colour.size(),
            );
            self.device.queue.submit([encoder.finish()]);
        })?;
        let samples = self.device.mapped(&self.staging)?;
        self.staging.unmap();
        Ok(samples)
    }

    fn pass(&self, encoder: &mut wgpu::CommandEncoder, batches: &[Batch]) {
        let [colour, depth] =
            [&self.colour, &self.depth].map(|texture| texture.create_view(&Default::default()));
        let [r, g, b] = self.background.map(|byte| f64::from(byte) / 255.0);
        let clear = wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &colour,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: clear, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        let [width, height] = viewport(self.size).map(|side| side as f32);
        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        for batch in batches {
            pass.set_bind_group(0, &batch.group, &[]);
            pass.draw(0..batch.vertices, 0..1);
        }
    }
}

fn uniform(look: &Look, size: [u32; 2]) -> Uniform {
    let (paint, scale) = match look.paint {
        Paint::Shaded => (0, None),
        Paint::Wireframe => (1, None),
        Paint::Map(scale) => (2, Some(scale)),
    };
    let end = |of: fn(&super::Scale) -> f64| scale.as_ref().map_or(0.0, of) as f32;
    Uniform {
        origin: [0.0; 2],
        size: viewport(size).map(|side| side as f32),
        paint,
        log: u32::from(scale.is_some_and(|scale| scale.log)),
        least: end(|scale| scale.least),
        most: end(|scale| scale.most),
        line: look.line * SAMPLES as f32,
        samples: SAMPLES as f32,
        spare: [0; 2],
        colours: std::array::from_fn(|k| {
            let [r, g, b] = colour(k as f64 / (COLOURS - 1) as f64);
            [r, g, b, u8::MAX].map(|byte| f32::from(byte) / 255.0)
        }),
    }
}

const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Samples of the viewport that a tile of `size` pixels is the upper left part of: powers of two,
/// so that corners are taken there and back without rounding.
fn viewport(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| (side * SAMPLES).next_power_of_two())
}

/// Bytes of a row of samples, as a copy wants them.
fn row(size: [u32; 2]) -> u32 {
    (4 * SAMPLES * size[0]).next_multiple_of(ROW)
}

fn buffer(device: &wgpu::Device, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn texture(
    device: &wgpu::Device,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("render.wgsl"),
        source: wgpu::ShaderSource::Wgsl(include_str!("render.wgsl").into()),
    });
    let binding = |binding: u32, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let group = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            binding(0, wgpu::BufferBindingType::Uniform),
            binding(1, wgpu::BufferBindingType::Storage { read_only: true }),
        ],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&group)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("render"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        // Both sides are seen.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("sample"),
            compilation_options: Default::default(),
            targets: &[Some(COLOUR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
