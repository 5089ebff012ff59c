//! The adapter: found, opened, given kernels and buffers, and read again.

use super::kernel::{Kernel, Sources};
use super::record::Dispatch;
use super::settings::Settings;
use crate::error::{Error, Result};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::Duration;

/// Invocations of a workgroup, in every kernel.
const GROUP: u32 = 64;

/// Groups along an axis of a dispatch, at most: what WebGPU promises.
const GROUPS_MAX: u32 = 65_535;

/// How long an answer may take after all work is done.
const PATIENCE: Duration = Duration::from_secs(60);

/// Which interface of the system is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// Vulkan, else OpenGL.
    #[default]
    Auto,
    /// Vulkan.
    Vulkan,
    /// OpenGL (ES 3.1 or newer).
    Gl,
}

impl Backend {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Vulkan, Self::Gl];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Vulkan => "vulkan",
            Self::Gl => "gl",
        }
    }

    /// What is tried, in order.
    fn choices(self) -> &'static [wgpu::Backends] {
        match self {
            Self::Auto => &[wgpu::Backends::VULKAN, wgpu::Backends::GL],
            Self::Vulkan => &[wgpu::Backends::VULKAN],
            Self::Gl => &[wgpu::Backends::GL],
        }
    }
}

/// A kernel, its entry, and how many buffers it has.
type Entry = (Kernel, &'static str, usize);

/// An open device, and the kernels that have been compiled for it.
pub struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    adapter: wgpu::AdapterInfo,
    sources: Sources,
    pipelines: Mutex<HashMap<Entry, Arc<wgpu::ComputePipeline>>>,
    /// Bytes that a binding may have.
    binding_max: u64,
    lost: Arc<Mutex<Option<String>>>,
    /// What was dispatched, while that is recorded.
    record: Mutex<Option<Vec<Dispatch>>>,
}

/// Words on the device.
#[derive(Clone, Debug)]
pub struct Buffer {
    buffer: wgpu::Buffer,
    words: usize,
}

impl Buffer {
    /// How many words of 32 bits.
    #[must_use]
    pub fn words(&self) -> usize {
        self.words
    }
}

/// Groups along both axes for so many invocations.
fn grid(items: u32) -> [u32; 2] {
    let groups = items.div_ceil(GROUP);
    let rows = groups.div_ceil(GROUPS_MAX);
    [groups.div_ceil(rows), rows]
}

impl Device {
    /// Opens the first adapter of the backend, with these kernels.
    ///
    /// # Errors
    /// [`Error::Device`] where there is none, with what to install.
    pub fn open(backend: Backend, sources: Sources) -> Result<Self> {
        let mut reasons = Vec::new();
        for &backends in backend.choices() {
            match pollster::block_on(Self::request(backends)) {
                Ok(device) => return Ok(Self { sources, ..device }),
                Err(reason) => reasons.push(reason),
            }
        }
        Err(Error::Device(format!(
            "no adapter for --backend {}: {}. A software one is enough: on Debian, `apt-get \
             install mesa-vulkan-drivers libvulkan1` for vulkan, `libegl1 libgl1-mesa-dri` for gl",
            backend.name(),
            reasons.join("; ")
        )))
    }

    async fn request(backends: wgpu::Backends) -> Result<Self, String> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let options = wgpu::RequestAdapterOptions::default();
        let adapter = instance.request_adapter(&options).await.map_err(|e| e.to_string())?;
        let (info, limits) = (adapter.get_info(), adapter.limits());
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("tessim"),
                required_limits: limits.clone(),
                ..Default::default()
            })
            .await
            .map_err(|e| e.to_string())?;
        let lost = Arc::new(Mutex::new(None));
        let note = |lost: &Arc<Mutex<Option<String>>>, reason: String| {
            lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(reason);
        };
        let seen = lost.clone();
        device.set_device_lost_callback(move |reason, message| {
            note(&seen, format!("the device is lost: {reason:?}: {message}"));
        });
        // What is objected to where nobody asks: of a device that is lost, anything may be.
        let seen = lost.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            note(&seen, error.to_string());
        }));
        Ok(Self {
            device,
            queue,
            adapter: info,
            sources: Sources::default(),
            pipelines: Mutex::default(),
            binding_max: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
            lost,
            record: Mutex::default(),
        })
    }

    /// The adapter and its driver, in words.
    #[must_use]
    pub fn name(&self) -> String {
        let wgpu::AdapterInfo { name, driver, driver_info, backend, .. } = &self.adapter;
        format!("{name} ({backend}, {driver} {driver_info})")
    }

    /// Words that a buffer may have.
    #[must_use]
    pub fn words_max(&self) -> usize {
        usize::try_from(self.binding_max / 4).unwrap_or(usize::MAX)
    }

    /// Takes no buffer of more words from now on, so that work is split earlier.
    pub fn limit_words(&mut self, words: usize) {
        self.binding_max = self.binding_max.min(4 * words as u64);
    }

    /// Gives the device back. Whatever is asked of it afterwards is an error.
    pub fn destroy(&self) {
        self.device.destroy();
        let mut lost = self.lost.lock().unwrap_or_else(PoisonError::into_inner);
        lost.get_or_insert_with(|| "the device is lost: it was given back".to_owned());
    }

    /// A buffer of these words.
    ///
    /// # Errors
    /// As [`Self::empty`].
    pub fn upload(&self, words: &[u32]) -> Result<Buffer> {
        let buffer = self.empty(words.len())?;
        self.queue.write_buffer(&buffer.buffer, 0, bytemuck::cast_slice(words));
        Ok(buffer)
    }

    /// A buffer of so many words, all 0.
    ///
    /// # Errors
    /// [`Error::Device`] where it is larger than a binding may be, or memory is short.
    pub fn empty(&self, words: usize) -> Result<Buffer> {
        let size = 4 * words.max(1) as u64;
        if size > self.binding_max {
            let max = self.binding_max;
            return Err(Error::Device(format!(
                "{}: a buffer of {size} bytes is larger than a binding may be, {max} bytes",
                self.name()
            )));
        }
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        let make = || self.make(size, usage);
        let buffer = self.guarded(wgpu::ErrorFilter::OutOfMemory, make)?;
        Ok(Buffer { buffer, words })
    }

    fn make(&self, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Runs `entry` of a kernel with an invocation for each of the settings' items; the buffers are
    /// its bindings from 1 on.
    ///
    /// # Errors
    /// [`Error::Device`] where the kernel does not compile, does not fit the device, or the device
    /// is lost.
    pub fn run(
        &self,
        kernel: Kernel,
        entry: &'static str,
        settings: &Settings,
        buffers: &[&Buffer],
    ) -> Result<()> {
        if settings.items == 0 {
            return Ok(());
        }
        let recorded = self.record.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        let before = if recorded { self.contents(buffers)? } else { Vec::new() };
        let groups = grid(settings.items);
        self.dispatch((kernel, entry), settings, buffers, groups)?;
        if !recorded {
            return Ok(());
        }
        let after = self.contents(buffers)?;
        let settings = bytemuck::cast_slice(bytemuck::bytes_of(settings)).to_vec();
        let files = Sources::parts(kernel);
        let dispatch = Dispatch { files, entry, groups, settings, before, after };
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        record.get_or_insert_default().push(dispatch);
        Ok(())
    }

    /// What is dispatched from now on is recorded, with the contents of all its buffers.
    pub fn record(&self) {
        *self.record.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
    }

    /// What was recorded; no more is.
    #[must_use]
    pub fn recorded(&self) -> Vec<Dispatch> {
        let mut record = self.record.lock().unwrap_or_else(PoisonError::into_inner);
        record.take().unwrap_or_default()
    }

    fn contents(&self, buffers: &[&Buffer]) -> Result<Vec<Vec<u32>>> {
        buffers.iter().map(|buffer| self.read(buffer, 0, buffer.words)).collect()
    }

    fn dispatch(
        &self,
        (kernel, entry): (Kernel, &'static str),
        settings: &Settings,
        buffers: &[&Buffer],
        [columns, rows]: [u32; 2],
    ) -> Result<()> {
        let pipeline = self.pipeline(kernel, entry, buffers.len())?;
        let uniform = self.make(
            size_of::<Settings>() as u64,
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        self.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(settings));
        let mut entries =
            vec![wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }];
        entries.extend(buffers.iter().enumerate().map(|(k, buffer)| wgpu::BindGroupEntry {
            binding: k as u32 + 1,
            resource: buffer.buffer.as_entire_binding(),
        }));
        self.guarded(wgpu::ErrorFilter::Validation, || {
            let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut encoder = self.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(columns, rows, 1);
            }
            self.queue.submit([encoder.finish()]);
        })
    }

    /// The words of a buffer from `first` on.
    ///
    /// # Errors
    /// [`Error::Device`] where the device is lost.
    ///
    /// # Panics
    /// When the buffer is shorter.
    pub fn read(&self, buffer: &Buffer, first: usize, words: usize) -> Result<Vec<u32>> {
        assert!(first + words <= buffer.words, "reads within the buffer");
        if words == 0 {
            return Ok(Vec::new());
        }
        let size = 4 * words as u64;
        let staging = self.make(size, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&buffer.buffer, 4 * first as u64, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        Ok(bytemuck::pod_collect_to_vec(&self.mapped(&staging)?))
    }

    /// The bytes of a buffer that can be mapped, when all that was submitted is done.
    pub(super) fn mapped(&self, staging: &wgpu::Buffer) -> Result<Vec<u8>> {
        let (sender, receiver) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody waits any more where waiting has failed.
            let _ = sender.send(result);
        });
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|reason| self.failed(&reason.to_string()))?;
        // Another thread's poll may be the one that answers, a little later.
        match receiver.recv_timeout(PATIENCE) {
            Ok(Ok(())) => {}
            other => return Err(self.failed(&format!("memory cannot be read: {other:?}"))),
        }
        let range = staging.get_mapped_range(..);
        Ok(range.map_err(|reason| self.failed(&reason.to_string()))?.to_vec())
    }

    fn pipeline(
        &self,
        kernel: Kernel,
        entry: &'static str,
        buffers: usize,
    ) -> Result<Arc<wgpu::ComputePipeline>> {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (kernel, entry, buffers);
        if let Some(pipeline) = pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        let text = self.sources.text(kernel);
        let made = self.guarded(wgpu::ErrorFilter::Validation, || self.compile(&text, key));
        let pipeline =
            Arc::new(made.map_err(|reason| {
                Error::Device(format!("{}, {entry}: {reason}", kernel.file()))
            })?);
        pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }

    fn compile(&self, text: &str, (kernel, entry, buffers): Entry) -> wgpu::ComputePipeline {
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(kernel.file()),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let binding = |binding: u32| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match binding {
                    0 => wgpu::BufferBindingType::Uniform,
                    _ => wgpu::BufferBindingType::Storage { read_only: false },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = (0..=buffers as u32).map(binding).collect();
        let group = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&group)],
            immediate_size: 0,
        });
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    /// Does `work`; what the device then objects to is an error.
    pub(super) fn guarded<T>(
        &self,
        filter: wgpu::ErrorFilter,
        work: impl FnOnce() -> T,
    ) -> Result<T> {
        let scope = self.device.push_error_scope(filter);
        let made = work();
        let error = pollster::block_on(scope.pop());
        // A lost device objects to everything: that it is lost says more.
        let lost = self.lost.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match lost.or_else(|| error.map(|error| error.to_string())) {
            Some(reason) => Err(self.failed(&reason)),
            None => Ok(made),
        }
    }

    pub(super) fn failed(&self, reason: &str) -> Error {
        Error::Device(format!("{}: {reason}", self.name()))
    }
}
