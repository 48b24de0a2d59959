//! OpenGL without a window or a desktop, by EGL.
//!
//! The library is loaded when the first picture is drawn. So the program needs no library of OpenGL to be built or to start.
//!
//! Source: EGL 1.5 and its extensions `EXT_device_base` and `EXT_platform_device`, <https://registry.khronos.org/EGL>.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::mem::{ManuallyDrop, transmute_copy};
use std::ptr::{null, null_mut};

use libloading::Library;

use crate::library::{loader_message, open};

/// The file of the library. EGL is for Linux; other systems have none of this name.
const LIBRARY: &str = "libEGL.so.1";

/// A device, a display, a configuration, a surface or a context of EGL.
type Handle = *mut c_void;

const NO_DISPLAY: Handle = null_mut();
const EXTENSIONS: c_int = 0x3055;
const PLATFORM_DEVICE: c_uint = 0x313F;
const OPENGL_API: c_uint = 0x30A2;
const NONE: c_int = 0x3038;
/// A surface in memory, and OpenGL with 8 bits per colour and a buffer of depths.
const CONFIGURATION: [c_int; 15] = [
    0x3033, 0x0001, // EGL_SURFACE_TYPE, EGL_PBUFFER_BIT
    0x3040, 0x0008, // EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT
    0x3024, 8, // EGL_RED_SIZE
    0x3023, 8, // EGL_GREEN_SIZE
    0x3022, 8, // EGL_BLUE_SIZE
    0x3025, 24, // EGL_DEPTH_SIZE
    0x3026, 8, // EGL_STENCIL_SIZE
    NONE,
];
/// The most devices that are tried. Computers have some graphics processors, and one device in software.
const MOST_DEVICES: usize = 64;

/// Defines the table of EGL's functions.
macro_rules! functions {
    ($($field:ident = $name:literal: fn($($type:ty),*) -> $result:ty;)*) => {
        struct Functions {
            $($field: unsafe extern "C" fn($($type),*) -> $result,)*
        }

        impl Functions {
            fn of(library: &Library) -> Result<Self, libloading::Error> {
                #[expect(unsafe_code, reason = "a library does not say what its functions take")]
                // SAFETY: the signatures are those of EGL 1.5. A function lives as long as the library, which is never unloaded.
                unsafe { Ok(Self { $($field: *library.get($name)?,)* }) }
            }
        }
    };
}

functions! {
    bind_api = "eglBindAPI": fn(c_uint) -> c_uint;
    choose_config = "eglChooseConfig": fn(Handle, *const c_int, *mut Handle, c_int, *mut c_int) -> c_uint;
    create_context = "eglCreateContext": fn(Handle, Handle, Handle, *const c_int) -> Handle;
    create_surface = "eglCreatePbufferSurface": fn(Handle, Handle, *const c_int) -> Handle;
    destroy_context = "eglDestroyContext": fn(Handle, Handle) -> c_uint;
    destroy_surface = "eglDestroySurface": fn(Handle, Handle) -> c_uint;
    error = "eglGetError": fn() -> c_int;
    initialize = "eglInitialize": fn(Handle, *mut c_int, *mut c_int) -> c_uint;
    make_current = "eglMakeCurrent": fn(Handle, Handle, Handle, Handle) -> c_uint;
    procedure = "eglGetProcAddress": fn(*const c_char) -> *mut c_void;
    text = "eglQueryString": fn(Handle, c_int) -> *const c_char;
}

/// `eglQueryDevicesEXT`.
type QueryDevices = unsafe extern "C" fn(c_int, *mut Handle, *mut c_int) -> c_uint;
/// `eglGetPlatformDisplayEXT`.
type GetPlatformDisplay = unsafe extern "C" fn(c_uint, Handle, *const c_int) -> Handle;

/// An OpenGL context that is current on the thread that has opened it.
pub(super) struct Context {
    display: Handle,
    surface: Handle,
    /// The OpenGL context itself.
    handle: Handle,
    functions: Functions,
    /// Never unloaded: drivers keep threads of their own.
    _library: ManuallyDrop<Library>,
}

impl Context {
    /// Opens a context on the first device that has one, and makes it current on this thread.
    ///
    /// # Errors
    /// The reason, if EGL or a driver is missing.
    pub(super) fn open() -> Result<Self, String> {
        let library = open(LIBRARY).map_err(|cause| loader_message(&cause))?;
        let functions = Functions::of(&library).map_err(|cause| loader_message(&cause))?;
        let (devices, platform_display) = functions.devices()?;
        let mut reason = "EGL has no device".to_owned();
        for device in devices {
            match functions.on_device(device, platform_display) {
                Ok([display, surface, handle]) => {
                    return Ok(Self { display, surface, handle, functions, _library: library });
                }
                Err(of_device) => reason = of_device,
            }
        }
        Err(reason)
    }

    /// Makes it current on this thread again, after another context.
    ///
    /// # Errors
    /// The reason of EGL.
    pub(super) fn make_current(&self) -> Result<(), String> {
        #[expect(unsafe_code, reason = "a function of EGL")]
        // SAFETY: the handles are those of `on_device`, and nothing has destroyed them.
        let made = unsafe { (self.functions.make_current)(self.display, self.surface, self.surface, self.handle) };
        if made == 0 { Err(self.functions.failure("eglMakeCurrent")) } else { Ok(()) }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        let (egl, none) = (&self.functions, null_mut());
        #[expect(unsafe_code, reason = "functions of EGL")]
        // SAFETY: the handles are those of `on_device`, and nothing has destroyed them. The display stays initialised, because another
        // thread may use it.
        unsafe {
            (egl.make_current)(self.display, none, none, none);
            (egl.destroy_surface)(self.display, self.surface);
            (egl.destroy_context)(self.display, self.handle);
        }
    }
}

impl Functions {
    /// The devices, and the function that gives their displays.
    fn devices(&self) -> Result<(Vec<Handle>, GetPlatformDisplay), String> {
        #[expect(unsafe_code, reason = "functions of EGL")]
        // SAFETY: EGL ends the text with a zero, and it never changes.
        let extensions = unsafe {
            let text = (self.text)(NO_DISPLAY, EXTENSIONS);
            if text.is_null() { c"" } else { CStr::from_ptr(text) }
        };
        let extensions = extensions.to_string_lossy();
        let has = |name: &str| extensions.split(' ').any(|extension| extension == name);
        let has_devices = has("EGL_EXT_device_base") || has("EGL_EXT_device_enumeration");
        if !(has_devices && has("EGL_EXT_platform_base") && has("EGL_EXT_platform_device")) {
            return Err("EGL cannot draw without a window".to_owned());
        }
        let mut devices = vec![null_mut(); MOST_DEVICES];
        let mut count = 0;
        #[expect(unsafe_code, reason = "functions of EGL")]
        // SAFETY: the extensions have these functions with these signatures. `devices` has room for the stated number.
        let platform_display = unsafe {
            let query = (self.procedure)(c"eglQueryDevicesEXT".as_ptr());
            let platform_display = (self.procedure)(c"eglGetPlatformDisplayEXT".as_ptr());
            if query.is_null() || platform_display.is_null() {
                return Err("EGL lacks a function of its extensions".to_owned());
            }
            let query: QueryDevices = transmute_copy(&query);
            let room = c_int::try_from(devices.len()).unwrap_or(c_int::MAX);
            if query(room, devices.as_mut_ptr(), &raw mut count) == 0 {
                return Err(self.failure("eglQueryDevicesEXT"));
            }
            transmute_copy(&platform_display)
        };
        devices.truncate(usize::try_from(count).unwrap_or(0));
        Ok((devices, platform_display))
    }

    /// The display, a surface and a current context of a device.
    fn on_device(&self, device: Handle, platform_display: GetPlatformDisplay) -> Result<[Handle; 3], String> {
        // MuJoCo draws into a buffer of its own. The surface is there because a context needs one.
        let size = [0x3057, 1, 0x3056, 1, NONE]; // EGL_WIDTH, EGL_HEIGHT
        let (mut config, mut count) = (null_mut(), 0);
        #[expect(unsafe_code, reason = "functions of EGL")]
        // SAFETY: `device` is one of EGL's devices, every list of attributes ends with `NONE`, and what a function has refused is not used.
        unsafe {
            let display = platform_display(PLATFORM_DEVICE, device, null());
            if display.is_null() {
                return Err(self.failure("eglGetPlatformDisplayEXT"));
            }
            if (self.initialize)(display, null_mut(), null_mut()) == 0 {
                return Err(self.failure("eglInitialize"));
            }
            if (self.bind_api)(OPENGL_API) == 0 {
                return Err(self.failure("eglBindAPI"));
            }
            let chosen = (self.choose_config)(display, CONFIGURATION.as_ptr(), &raw mut config, 1, &raw mut count);
            if chosen == 0 || count < 1 {
                return Err(self.failure("eglChooseConfig"));
            }
            let surface = (self.create_surface)(display, config, size.as_ptr());
            if surface.is_null() {
                return Err(self.failure("eglCreatePbufferSurface"));
            }
            let context = (self.create_context)(display, config, null_mut(), null());
            if context.is_null() {
                let failure = self.failure("eglCreateContext");
                (self.destroy_surface)(display, surface);
                return Err(failure);
            }
            if (self.make_current)(display, surface, surface, context) == 0 {
                let failure = self.failure("eglMakeCurrent");
                (self.destroy_surface)(display, surface);
                (self.destroy_context)(display, context);
                return Err(failure);
            }
            Ok([display, surface, context])
        }
    }

    /// What the last function, of this name, says of its failure.
    fn failure(&self, function: &str) -> String {
        #[expect(unsafe_code, reason = "a function of EGL")]
        // SAFETY: it takes nothing.
        let code = unsafe { (self.error)() };
        format!("{function} failed with {code:#x}")
    }
}
