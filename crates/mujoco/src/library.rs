//! Loads MuJoCo's library on first use, so that the program starts without it.
//!
//! mujoco-rs declares MuJoCo's functions as symbols for the linker. This module defines all symbols that the program
//! uses. The linker then needs nothing from the library, and the loader does not search it at the start of the program.
//! Each definition forwards its call to the function of the same name in the library.
//!
//! Why: docs/decisions/mujoco.md#mujocos-library-is-loaded-on-first-use.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::error::Error as _;
use std::ffi::{c_char, c_int, c_uchar, c_void};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, OnceLock};

use libloading::Library;
use mujoco_rs::mujoco_c;
use mujoco_rs::mujoco_c::{
    mjData, mjLogConfig, mjModel, mjVERSION_HEADER, mjVFS, mjfLogHandler, mjrContext, mjrRect, mjvCamera, mjvGeom,
    mjvOption, mjvPerturb, mjvScene,
};
#[cfg(feature = "viewer")]
use mujoco_rs::mujoco_c::{mjOption, mjSpec, mjVisual};

/// The reason why MuJoCo's library cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LibraryError {
    /// The loader does not find the library, or cannot use it.
    #[error(
        "MuJoCo's library cannot be loaded ({cause}): run `cargo x setup` in a checkout, or `pip install mujoco=={}` for Python, or use the \
         simulator `quasistatic`, which does not need it",
        shown(NEEDED)
    )]
    NotLoaded {
        /// The message of the loader.
        cause: String,
    },
    /// The library is of another version.
    #[error(
        "MuJoCo {needed} is needed, but {} is MuJoCo {}: run `cargo x setup` in a checkout, or `pip install mujoco=={needed}` for Python, or \
         set its variable `VIBRISSA_MUJOCO` to the path of a library of {needed}, or use the simulator `quasistatic`, which needs none",
        file.display(), shown(*found), needed = shown(NEEDED)
    )]
    Version {
        /// The file, or its name if the loader searched it.
        file: PathBuf,
        /// Its version, as MuJoCo counts: 3 017 000 is 3.17.0.
        found: c_int,
    },
}

/// The version that mujoco-rs requires, as MuJoCo counts.
const NEEDED: c_int = mjVERSION_HEADER.cast_signed();

/// The file of the library, if its place is known.
static FILE: OnceLock<PathBuf> = OnceLock::new();

/// Sets the file of MuJoCo's library, for a program whose loader does not find it. The plugin for cables is in the same
/// folder, or in its folder `plugin`. Call it before the first simulation, because the library is loaded once.
///
/// # Errors
/// [`LibrarySet`] if another file is set already.
pub fn set_library(file: &Path) -> Result<(), LibrarySet> {
    if FILE.get_or_init(|| file.to_owned()) == file { Ok(()) } else { Err(LibrarySet) }
}

/// Another file of MuJoCo's library is set already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("another file of MuJoCo's library is set already; set it once, before the first run")]
pub struct LibrarySet;

/// The folder of the library, if the program states it, or if it is the folder of the program.
pub(super) fn stated_folder() -> Option<&'static Path> {
    file().and_then(Path::parent)
}

/// The file of the library: the stated one, or the one in the folder of the program, as in a release. `None` leaves the search to the
/// loader.
fn file() -> Option<&'static Path> {
    if let (None, Some(file)) = (FILE.get(), beside_program()) {
        // If another thread has stated a file meanwhile, that one is used.
        let _ = FILE.set(file);
    }
    FILE.get().map(PathBuf::as_path)
}

/// The library in the folder of the program.
fn beside_program() -> Option<PathBuf> {
    let name = file_name();
    let name = Path::new(&name).file_name()?;
    Some(std::env::current_exe().ok()?.canonicalize().ok()?.with_file_name(name)).filter(|file| file.is_file())
}

/// The functions of the loaded library. It is never unloaded.
static FUNCTIONS: LazyLock<Result<Functions, LibraryError>> = LazyLock::new(|| {
    let failed = |cause: libloading::Error| LibraryError::NotLoaded { cause: loader_message(&cause) };
    let file = file().map_or_else(|| file_name().into(), Path::to_path_buf);
    let library = open(&file).map_err(failed)?;
    // First of all, because another version may lack functions, and mujoco-rs panics.
    let found = version_of(&library).map_err(failed)?;
    if found != NEEDED {
        return Err(LibraryError::Version { file, found });
    }
    Functions::of(&library).map_err(failed)
});

/// The version of a library, as MuJoCo counts. The function is the same in all versions.
fn version_of(library: &Library) -> Result<c_int, libloading::Error> {
    #[expect(unsafe_code, reason = "a library does not say what its functions take")]
    // SAFETY: this is the signature of MuJoCo's function in all versions that have it.
    unsafe {
        library.get::<unsafe extern "C" fn() -> c_int>("mj_version").map(|version| version())
    }
}

/// Loads the library once per process.
///
/// # Errors
/// [`LibraryError`] if the loader does not find the library, or if it is not usable, such as another version.
pub(super) fn load() -> Result<(), LibraryError> {
    FUNCTIONS.as_ref().map(|_| ()).map_err(Clone::clone)
}

/// Loads a library for the rest of the process.
pub(super) fn open(name: impl AsRef<std::ffi::OsStr>) -> Result<std::mem::ManuallyDrop<Library>, libloading::Error> {
    #[expect(unsafe_code, reason = "a library runs code of its own when it is loaded")]
    // SAFETY: it is MuJoCo's library, one of its plugins, or EGL. Their initialisers only set up themselves.
    let library = unsafe { Library::new(name.as_ref()) };
    library.map(std::mem::ManuallyDrop::new)
}

/// The message of the loader, with the name of the file.
pub(super) fn loader_message(cause: &libloading::Error) -> String {
    cause.source().map_or_else(|| cause.to_string(), ToString::to_string)
}

/// A version that is counted as MuJoCo counts.
fn shown(version: c_int) -> String {
    format!("{}.{}.{}", version / 1_000_000, version / 1000 % 1000, version % 1000)
}

/// The file name of the library version that mujoco-rs requires. The program's loader path includes its directory.
fn file_name() -> String {
    let version = shown(NEEDED);
    if cfg!(target_vendor = "apple") {
        format!("@rpath/{DLL_PREFIX}mujoco.{version}{DLL_SUFFIX}")
    } else {
        format!("{DLL_PREFIX}mujoco{DLL_SUFFIX}.{version}")
    }
}

/// The functions for calls of mujoco-rs. Every use of MuJoCo in this crate comes after [`load`], so they are available.
/// A use of mujoco-rs without it ends the process here.
#[expect(clippy::print_stderr, reason = "MuJoCo's functions cannot tell that they are missing")]
fn functions() -> &'static Functions {
    FUNCTIONS.as_ref().unwrap_or_else(|error| {
        eprintln!("error: {error}");
        std::process::exit(2)
    })
}

/// Defines the forwarding functions and the table of the library's functions, each group only under its attribute. A
/// signature that differs from mujoco-rs does not compile. A missing function would link the program to the library
/// again; a test checks this.
macro_rules! pass_on {
    ($(#[$cfg:meta] { $(fn $name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)* })*) => {
        #[expect(non_snake_case, reason = "MuJoCo's names")]
        struct Functions {
            $($(#[$cfg] $name: unsafe extern "C" fn($($type),*) $(-> $result)?,)*)*
        }

        impl Functions {
            fn of(library: &Library) -> Result<Self, libloading::Error> {
                #[expect(unsafe_code, reason = "a library does not say what its functions take")]
                // SAFETY: the file name contains MuJoCo's version, and the signatures are those of that version.
                unsafe { Ok(Self { $($(#[$cfg] $name: *library.get(stringify!($name))?,)*)* }) }
            }
        }

        $($(
            #[$cfg]
            const _: unsafe extern "C" fn($($type),*) $(-> $result)? = mujoco_c::$name;

            #[$cfg]
            #[expect(unsafe_code, reason = "mujoco-rs leaves the function to the linker")]
            // SAFETY: the name is unique in the program. The caller must meet the requirements of the function in the
            // library.
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name($($argument: $type),*) $(-> $result)? {
                unsafe { (functions().$name)($($argument),*) }
            }
        )*)*
    };
}

pass_on! {
    #[cfg(feature = "sim")] {
        fn mj_addBufferVFS(vfs: *mut mjVFS, name: *const c_char, buffer: *const c_void, length: c_int) -> c_int;
        fn mj_defaultVFS(vfs: *mut mjVFS);
        fn mj_deleteData(data: *mut mjData);
        fn mj_deleteModel(model: *mut mjModel);
        fn mj_deleteVFS(vfs: *mut mjVFS);
        fn mj_energyPos(model: *const mjModel, data: *mut mjData);
        fn mj_energyVel(model: *const mjModel, data: *mut mjData);
        fn mj_forward(model: *const mjModel, data: *mut mjData);
        fn mj_loadXML(file: *const c_char, vfs: *const mjVFS, error: *mut c_char, length: c_int) -> *mut mjModel;
        fn mj_makeData(model: *const mjModel) -> *mut mjData;
        fn mj_name2id(model: *const mjModel, kind: c_int, name: *const c_char) -> c_int;
        fn mj_resetDataKeyframe(model: *const mjModel, data: *mut mjData, key: c_int);
        fn mj_step(model: *const mjModel, data: *mut mjData);
        fn mj_version() -> c_int;
        fn mj_versionString() -> *const c_char;
        fn mju_getLogConfig() -> mjLogConfig;
        fn mju_setLogConfig(config: mjLogConfig);
        fn mju_setLogHandler(handler: mjfLogHandler) -> mjfLogHandler;
        fn mjr_defaultContext(context: *mut mjrContext);
        fn mjr_freeContext(context: *mut mjrContext);
        fn mjr_makeContext(model: *const mjModel, context: *mut mjrContext, font_scale: c_int);
        fn mjr_readPixels(rgb: *mut c_uchar, depth: *mut f32, viewport: mjrRect, context: *const mjrContext);
        fn mjr_render(viewport: mjrRect, scene: *mut mjvScene, context: *const mjrContext);
        fn mjr_setBuffer(buffer: c_int, context: *mut mjrContext);
        fn mjv_connector(geom: *mut mjvGeom, kind: c_int, width: f64, from: *const [f64; 3], to: *const [f64; 3]);
        fn mjv_defaultCamera(camera: *mut mjvCamera);
        fn mjv_defaultOption(option: *mut mjvOption);
        fn mjv_defaultPerturb(perturbation: *mut mjvPerturb);
        fn mjv_defaultScene(scene: *mut mjvScene);
        fn mjv_freeScene(scene: *mut mjvScene);
        fn mjv_initGeom(
            geom: *mut mjvGeom,
            kind: c_int,
            size: *const [f64; 3],
            position: *const [f64; 3],
            orientation: *const [f64; 9],
            colour: *const [f32; 4]
        );
        fn mjv_makeScene(model: *const mjModel, scene: *mut mjvScene, most_geoms: c_int);
        fn mjv_updateScene(
            model: *const mjModel,
            data: *mut mjData,
            option: *const mjvOption,
            perturbation: *const mjvPerturb,
            camera: *mut mjvCamera,
            categories: c_int,
            scene: *mut mjvScene
        );
    }
    #[cfg(feature = "viewer")] {
        fn mj_actuatorInputName(model: *const mjModel, actuator: c_int, input: c_int) -> *const c_char;
        fn mj_compile(spec: *mut mjSpec, vfs: *const mjVFS) -> *mut mjModel;
        fn mj_copyData(to: *mut mjData, model: *const mjModel, from: *const mjData) -> *mut mjData;
        fn mj_copyModel(to: *mut mjModel, from: *const mjModel) -> *mut mjModel;
        fn mj_defaultOption(option: *mut mjOption);
        fn mj_defaultVisual(visual: *mut mjVisual);
        fn mj_deleteSpec(spec: *mut mjSpec);
        fn mj_getState(model: *const mjModel, data: *const mjData, state: *mut f64, parts: c_int);
        fn mj_id2name(model: *const mjModel, kind: c_int, id: c_int) -> *const c_char;
        fn mj_makeSpec() -> *mut mjSpec;
        fn mj_resetData(model: *const mjModel, data: *mut mjData);
        fn mj_setState(model: *const mjModel, data: *mut mjData, state: *const f64, parts: c_int);
        fn mj_stateSize(model: *const mjModel, parts: c_int) -> c_int;
        fn mjr_changeFont(scale: c_int, context: *mut mjrContext);
        fn mjr_overlay(
            font: c_int,
            place: c_int,
            viewport: mjrRect,
            left: *const c_char,
            right: *const c_char,
            context: *const mjrContext
        );
        fn mjr_uploadHField(model: *const mjModel, context: *const mjrContext, field: c_int);
        fn mjr_uploadMesh(model: *const mjModel, context: *const mjrContext, mesh: c_int);
        fn mjr_uploadTexture(model: *const mjModel, context: *const mjrContext, texture: c_int);
        fn mjs_getError(spec: *mut mjSpec) -> *const c_char;
        fn mju_normalize3(vector: *mut [f64; 3]) -> f64;
        fn mju_normalize4(vector: *mut [f64; 4]) -> f64;
        fn mju_quat2Vel(velocity: *mut [f64; 3], rotation: *const [f64; 4], time: f64);
        fn mjv_applyPerturbForce(model: *const mjModel, data: *mut mjData, perturbation: *const mjvPerturb);
        fn mjv_applyPerturbPose(
            model: *const mjModel,
            data: *mut mjData,
            perturbation: *const mjvPerturb,
            is_paused: c_int
        );
        fn mjv_copyData(to: *mut mjData, model: *const mjModel, from: *const mjData) -> *mut mjData;
        fn mjv_defaultFreeCamera(model: *const mjModel, camera: *mut mjvCamera);
        fn mjv_initPerturb(
            model: *const mjModel,
            data: *mut mjData,
            scene: *const mjvScene,
            perturbation: *mut mjvPerturb
        );
        fn mjv_moveCamera(model: *const mjModel, action: c_int, x: f64, y: f64, camera: *mut mjvCamera);
        fn mjv_movePerturb(
            model: *const mjModel,
            data: *const mjData,
            action: c_int,
            x: f64,
            y: f64,
            scene: *const mjvScene,
            perturbation: *mut mjvPerturb
        );
        fn mjv_select(
            model: *const mjModel,
            data: *const mjData,
            option: *const mjvOption,
            aspect: f64,
            x: f64,
            y: f64,
            scene: *const mjvScene,
            point: *mut [f64; 3],
            geom: *mut c_int,
            flex: *mut c_int,
            skin: *mut c_int
        ) -> c_int;
    }
}
