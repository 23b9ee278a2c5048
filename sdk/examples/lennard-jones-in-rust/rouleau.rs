//! The part of rouleau/plugin.h that an interaction uses, field by field; the header says what each of them means.
#![allow(dead_code)]
use std::os::raw::{c_char, c_int, c_void};

pub const ABI_MINOR: u32 = 0;
pub const INTERACTION_KIND: u32 = 3;

#[repr(C)]
pub struct Setup {
    pub struct_size: u32,
    pub host_minor: u32,
    pub parameter_count: u32,
    pub parameter_names: *const *const c_char,
    pub parameter_values: *const f64,
    pub length_unit: f64,
    pub time_unit: f64,
    pub mass_unit: f64,
    pub dimension: u32,
    pub velocity_count: u32,
    pub velocities: *const f64,
    pub weights: *const f64,
    pub sound_speed_squared: f64,
    pub relaxation_rate: f64,
    pub inertia: u32,
}

#[repr(C)]
pub struct InteractionBlock {
    pub struct_size: u32,
    pub count: u32,
    pub time_step: f64,
    pub distance: *const f64,
    pub normal_velocity: *const f64,
    pub tangential_velocity: *const f64,
    pub energy: *mut f64,
    pub force: *mut f64,
    pub force_by_distance: *mut f64,
    pub state: *const *const f64,
    pub new_state: *const *mut f64,
}

#[repr(C)]
pub struct Interaction {
    pub struct_size: u32,
    pub cutoff: unsafe extern "C" fn(*const c_void) -> f64,
    pub compute: unsafe extern "C" fn(*const c_void, *const InteractionBlock),
}

#[repr(C)]
pub struct Model {
    pub struct_size: u32,
    pub kind: u32,
    pub id: *const c_char,
    pub version: *const c_char,
    pub create: unsafe extern "C" fn(*const Setup, *mut *mut c_void, *mut c_char, usize) -> c_int,
    pub destroy: unsafe extern "C" fn(*mut c_void),
    pub collision: *const c_void,
    pub membrane: *const c_void,
    pub interaction: *const Interaction,
}

#[repr(C)]
pub struct Plugin {
    pub struct_size: u32,
    pub abi_minor: u32,
    pub models: *const *const Model,
}

/// A table that is never changed, whatever its pointers let one suppose.
#[repr(transparent)]
pub struct Table<T>(pub T);
unsafe impl<T> Sync for Table<T> {}

/// The size of a struct, for its field struct_size.
pub const fn size_of<T>() -> u32 {
    std::mem::size_of::<T>() as u32
}
