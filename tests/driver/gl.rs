//! The driver: OpenGL through EGL, without a window. Tessellation factors in, what the tessellator
//! made of them out: the coordinates by transform feedback, the counts by queries.
//!
//! The one place of the main package where `unsafe` is needed: EGL and OpenGL are C, and neither
//! what their functions point to nor that a context is current can be seen by Rust. The library is
//! loaded at run time, so that nothing of it is needed to build.
//!
//! The software device is asked for by name, through EGL's device extensions: no variable of the
//! environment is set, and a graphics card in the machine is left alone.

#![expect(unsafe_code, reason = "the boundary to the driver, which is C")]

use glow::HasContext;
use khronos_egl as egl;
use std::ffi::{CStr, c_char, c_void};

/// EGL_EXT_platform_device.
const PLATFORM_DEVICE: egl::Enum = 0x313f;
/// GL_ARB_pipeline_statistics_query, which glow knows no names of.
const CONTROL_PATCHES: u32 = 0x82f1;
const EVALUATION_INVOCATIONS: u32 = 0x82f2;
const CLIPPING_INPUT_PRIMITIVES: u32 = 0x82f6;

type Egl = egl::DynamicInstance<egl::EGL1_5>;
type QueryDevices = unsafe extern "system" fn(i32, *mut *mut c_void, *mut i32) -> u32;
type QueryDeviceString = unsafe extern "system" fn(*mut c_void, i32) -> *const c_char;

/// The factors of a patch, as bits of singles: four of the edges, two of the inside.
pub(crate) type Bits = [u32; 6];

/// Bytes of a captured vertex.
const STRIDE: usize = 16;
/// Captured vertices that a draw has room for: four patches of 64 by 64 cells of two triangles.
const ROOM: usize = 4 * 64 * 64 * 6;

/// A vertex as it was captured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Captured {
    /// gl_TessCoord, as bits of singles.
    pub(crate) coordinate: [u32; 3],
    /// gl_PrimitiveID: which patch of the draw.
    pub(crate) patch: u32,
}

/// What a draw gave.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Capture {
    /// The primitives' vertices in order, as many for each as the primitive has.
    pub(crate) vertices: Vec<Captured>,
    /// Patches that the control shader was run for.
    pub(crate) patches: u32,
    /// Invocations of the evaluation shader.
    pub(crate) evaluations: u32,
    /// Primitives generated.
    pub(crate) primitives: u32,
    /// Primitives that reached clipping.
    pub(crate) clipped: u32,
}

/// The sources of a program's shaders.
pub(crate) struct Sources {
    pub(crate) vertex: &'static str,
    pub(crate) control: &'static str,
    pub(crate) evaluation: String,
    /// The evaluation shader's outputs to capture, 16 bytes a vertex in all.
    pub(crate) captured: [&'static str; 2],
}

/// A context of the driver, current in the thread that opened it.
pub(crate) struct Driver {
    gl: glow::Context,
    factors: glow::Buffer,
    queries: [(u32, glow::Query); 5],
    /// The driver's own words on itself.
    pub(crate) name: String,
    // Behind what was loaded from it: dropped last.
    _egl: Egl,
}

/// A linked program.
#[derive(Clone, Copy)]
pub(crate) struct Program(glow::Program);

impl Driver {
    /// A context of llvmpipe, or why there is none on this machine.
    pub(crate) fn open() -> Result<Self, String> {
        // SAFETY: a library of this name is EGL by its platform's convention.
        let egl = unsafe { Egl::load_required() }.map_err(|e| format!("no EGL 1.5: {e}"))?;
        context(&egl)?;
        let load = |name: &str| {
            egl.get_proc_address(name).map_or(std::ptr::null(), |f| f as *const c_void)
        };
        // SAFETY: the functions are of the context that is current now; `Driver` is not `Send`
        // (glow's context is not), so that it stays current wherever they are called.
        let gl = unsafe { glow::Context::from_loader_function(load) };
        // SAFETY: a current context is all that is asked.
        let [renderer, version] =
            [glow::RENDERER, glow::VERSION].map(|name| unsafe { gl.get_parameter_string(name) });
        let name = format!("{renderer}, OpenGL {version}");
        if !renderer.starts_with("llvmpipe") {
            return Err(format!("the software device is {name}, not llvmpipe"));
        }
        if !gl.supported_extensions().contains("GL_ARB_pipeline_statistics_query") {
            return Err(format!("{name} lacks GL_ARB_pipeline_statistics_query"));
        }
        // SAFETY: as above; the buffer's size fits.
        let (factors, queries) = unsafe { state(&gl) };
        let driver = Self { gl, factors, queries, name, _egl: egl };
        driver.no_error("setting up");
        Ok(driver)
    }

    /// Compiles and links; panics with the driver's words where it refuses.
    pub(crate) fn program(&self, sources: &Sources) -> Program {
        let stages = [
            (glow::VERTEX_SHADER, sources.vertex),
            (glow::TESS_CONTROL_SHADER, sources.control),
            (glow::TESS_EVALUATION_SHADER, &sources.evaluation),
        ];
        let gl = &self.gl;
        // SAFETY: every name is one that the context has just made.
        unsafe {
            let program = gl.create_program().expect("a program");
            for (stage, source) in stages {
                let shader = gl.create_shader(stage).expect("a shader");
                gl.shader_source(shader, source);
                gl.compile_shader(shader);
                let log = gl.get_shader_info_log(shader);
                assert!(gl.get_shader_compile_status(shader), "{log}\n{source}");
                gl.attach_shader(program, shader);
                gl.delete_shader(shader);
            }
            let captured = &sources.captured;
            gl.transform_feedback_varyings(program, captured, glow::INTERLEAVED_ATTRIBS);
            gl.link_program(program);
            let log = gl.get_program_info_log(program);
            assert!(gl.get_program_link_status(program), "{log}");
            Program(program)
        }
    }

    /// Gives a program back.
    pub(crate) fn delete(&self, program: Program) {
        // SAFETY: the context made it, and the value is gone with this call.
        unsafe { self.gl.delete_program(program.0) };
    }

    /// Draws patches in one call. A primitive has `corners` vertices: 1 a point, 2 a line, 3 a
    /// triangle.
    pub(crate) fn draw(&self, program: Program, corners: u32, patches: &[Bits]) -> Capture {
        let primitive = [glow::POINTS, glow::LINES, glow::TRIANGLES][corners as usize - 1];
        let bytes: Vec<u8> = patches.as_flattened().iter().flat_map(|b| b.to_ne_bytes()).collect();
        let gl = &self.gl;
        // SAFETY: the draw reads a vertex of 24 bytes a patch, which is what is uploaded before;
        // it writes at most the captured buffer's size, which the driver keeps to.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.factors));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &bytes, glow::STREAM_DRAW);
            gl.use_program(Some(program.0));
            for (target, query) in self.queries {
                gl.begin_query(target, query);
            }
            gl.begin_transform_feedback(primitive);
            gl.draw_arrays(glow::PATCHES, 0, patches.len() as i32);
            gl.end_transform_feedback();
            for (target, _) in self.queries {
                gl.end_query(target);
            }
        }
        // SAFETY: the queries have ended; the answer waits for the draw.
        let answer = |(_, query)| unsafe { gl.get_query_parameter_u32(query, glow::QUERY_RESULT) };
        let [written, primitives, patches, evaluations, clipped] = self.queries.map(answer);
        assert_eq!(written, primitives, "captured of those generated: no room for the rest");
        let vertices = self.read((written * corners) as usize);
        self.no_error("a draw");
        Capture { vertices, patches, evaluations, primitives, clipped }
    }

    /// The first vertices of the captured buffer.
    fn read(&self, vertices: usize) -> Vec<Captured> {
        assert!(vertices <= ROOM, "{vertices} vertices written into room for {ROOM}");
        let mut bytes = vec![0; vertices * STRIDE];
        // SAFETY: the slice is of the length that is asked for, within the buffer's size.
        unsafe {
            self.gl.get_buffer_sub_data(glow::TRANSFORM_FEEDBACK_BUFFER, 0, &mut bytes);
        }
        let vertex = |bytes: &[u8]| {
            let word = |at: usize| {
                u32::from_ne_bytes(bytes[4 * at..][..4].try_into().expect("four of 16 bytes"))
            };
            Captured { coordinate: [word(0), word(1), word(2)], patch: word(3) }
        };
        bytes.chunks_exact(STRIDE).map(vertex).collect()
    }

    fn no_error(&self, what: &str) {
        // SAFETY: a current context is all that is asked.
        let error = unsafe { self.gl.get_error() };
        assert_eq!(error, glow::NO_ERROR, "{what}: OpenGL error {error:#x}");
    }
}

/// Makes a context of the software device current; the display lives as long as the process.
fn context(egl: &Egl) -> Result<(), String> {
    let device = software_device(egl)?;
    // SAFETY: the pointer is a device of this EGL, as this platform wants it.
    let display = unsafe { egl.get_platform_display(PLATFORM_DEVICE, device, &[egl::ATTRIB_NONE]) }
        .map_err(|e| format!("no display: {e}"))?;
    egl.initialize(display).map_err(|e| format!("no display: {e}"))?;
    egl.bind_api(egl::OPENGL_API).map_err(|e| format!("no OpenGL: {e}"))?;
    let wanted = [egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::SURFACE_TYPE, 0, egl::NONE];
    let config = egl.choose_first_config(display, &wanted).ok().flatten();
    let config = config.ok_or("no configuration for OpenGL")?;
    #[rustfmt::skip]
    let wanted = [
        egl::CONTEXT_MAJOR_VERSION, 4,
        egl::CONTEXT_MINOR_VERSION, 0, // tessellation came with it
        egl::CONTEXT_OPENGL_PROFILE_MASK, egl::CONTEXT_OPENGL_CORE_PROFILE_BIT,
        egl::NONE,
    ];
    let context = egl.create_context(display, config, None, &wanted);
    let context = context.map_err(|e| format!("no context of OpenGL 4.0: {e}"))?;
    let current = egl.make_current(display, None, None, Some(context));
    current.map_err(|e| format!("no context without a surface: {e}"))
}

/// The device that says of itself that it is software.
fn software_device(egl: &Egl) -> Result<*mut c_void, String> {
    const LACKS: &str = "EGL lacks EGL_EXT_device_enumeration";
    let devices = egl.get_proc_address("eglQueryDevicesEXT").ok_or(LACKS)?;
    let strings = egl.get_proc_address("eglQueryDeviceStringEXT").ok_or(LACKS)?;
    // SAFETY: the extension gives the functions of these names these types.
    let query: QueryDevices = unsafe { std::mem::transmute(devices) };
    // SAFETY: as above.
    let string: QueryDeviceString = unsafe { std::mem::transmute(strings) };
    let mut devices = [std::ptr::null_mut(); 16];
    let mut count = 0;
    // SAFETY: room for as many devices as are asked for.
    let queried = unsafe { query(devices.len() as i32, devices.as_mut_ptr(), &mut count) };
    if queried == 0 {
        return Err("EGL lists no devices".to_owned());
    }
    let software = |device: &*mut c_void| {
        // SAFETY: a device that was listed; the string is the library's, or null.
        let names = unsafe {
            let names = string(*device, egl::EXTENSIONS);
            if names.is_null() { c"" } else { CStr::from_ptr(names) }
        };
        names.to_string_lossy().split(' ').any(|name| name == "EGL_MESA_device_software")
    };
    let listed = &devices[..count as usize];
    listed.iter().copied().find(software).ok_or_else(|| {
        format!("none of EGL's {count} devices is software (Debian: libegl1, libgl1-mesa-dri)")
    })
}

/// What all draws share: buffers, a vertex layout of six integers, a framebuffer, queries.
///
/// # Safety
///
/// The context must be current.
unsafe fn state(gl: &glow::Context) -> (glow::Buffer, [(u32, glow::Query); 5]) {
    // SAFETY: every name is one that the context has just made; offsets and strides are those of
    // `Bits`; the captured buffer has its size before it is bound.
    unsafe {
        let factors = gl.create_buffer().expect("a buffer");
        gl.bind_vertex_array(Some(gl.create_vertex_array().expect("an array")));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(factors));
        // Integers, so that nothing on the way may take a NaN for another.
        let stride = size_of::<Bits>() as i32;
        for (index, size, offset) in [(0, 4, 0), (1, 2, 16)] {
            gl.vertex_attrib_pointer_i32(index, size, glow::UNSIGNED_INT, stride, offset);
            gl.enable_vertex_attrib_array(index);
        }
        gl.patch_parameter_i32(glow::PATCH_VERTICES, 1);
        let captured = gl.create_buffer().expect("a buffer");
        gl.bind_buffer(glow::TRANSFORM_FEEDBACK_BUFFER, Some(captured));
        let size = (ROOM * STRIDE) as i32;
        gl.buffer_data_size(glow::TRANSFORM_FEEDBACK_BUFFER, size, glow::STREAM_READ);
        gl.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, Some(captured));
        // Nothing is drawn into it, but without a surface a draw is refused where none is bound.
        let framebuffer = gl.create_framebuffer().expect("a framebuffer");
        let target = gl.create_renderbuffer().expect("a renderbuffer");
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(target));
        gl.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, 1, 1);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let (at, kind) = (glow::COLOR_ATTACHMENT0, glow::RENDERBUFFER);
        gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, at, kind, Some(target));
        let targets = [
            glow::TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN,
            glow::PRIMITIVES_GENERATED,
            CONTROL_PATCHES,
            EVALUATION_INVOCATIONS,
            CLIPPING_INPUT_PRIMITIVES,
        ];
        let queries = targets.map(|target| (target, gl.create_query().expect("a query")));
        (factors, queries)
    }
}
