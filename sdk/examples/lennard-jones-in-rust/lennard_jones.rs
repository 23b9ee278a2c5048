//! The Lennard-Jones potential per membrane area in Rust: phi = De (s^2 - 2 s), s = (r0/r)^6; force 12 De s (s - 1)/r.
//! Lennard-Jones (Proc. Phys. Soc. 43, 1931).
mod rouleau;

use rouleau::*;
use std::os::raw::{c_char, c_int, c_void};

struct LennardJones {
    depth: f64,
    r0: f64,
    cutoff: f64,
}

unsafe extern "C" fn create(setup: *const Setup, model: *mut *mut c_void, error: *mut c_char, size: usize) -> c_int {
    if (*setup).parameter_count != 3 {
        let words = b"three parameters are wanted\0";
        let length = words.len().min(size);
        std::ptr::copy_nonoverlapping(words.as_ptr() as *const c_char, error, length);
        return 1;
    }
    // In the manifest's order, in lattice units.
    let value = std::slice::from_raw_parts((*setup).parameter_values, 3);
    *model = Box::into_raw(Box::new(LennardJones { depth: value[0], r0: value[1], cutoff: value[2] })) as *mut c_void;
    0
}

unsafe extern "C" fn destroy(model: *mut c_void) {
    drop(Box::from_raw(model as *mut LennardJones));
}

unsafe extern "C" fn cutoff(model: *const c_void) -> f64 {
    (*(model as *const LennardJones)).cutoff
}

unsafe extern "C" fn compute(model: *const c_void, block: *const InteractionBlock) {
    let (model, block) = (&*(model as *const LennardJones), &*block);
    // Outputs that the host does not want are null.
    let give = |to: *mut f64, i: usize, value: f64| {
        if !to.is_null() {
            *to.add(i) = value;
        }
    };
    for i in 0..block.count as usize {
        let r = *block.distance.add(i);
        let t = model.r0 / r;
        let s = (t * t * t) * (t * t * t);
        give(block.energy, i, model.depth * s * (s - 2.0));
        give(block.force, i, 12.0 * model.depth * s * (s - 1.0) / r);
        give(block.force_by_distance, i, 12.0 * model.depth * s * (7.0 - 13.0 * s) / (r * r));
    }
}

static FUNCTIONS: Table<Interaction> = Table(Interaction { struct_size: size_of::<Interaction>(), cutoff, compute });
static MODEL: Table<Model> = Table(Model {
    struct_size: size_of::<Model>(),
    kind: INTERACTION_KIND,
    id: b"org.example.lennard-jones-in-rust\0".as_ptr() as *const c_char,
    version: b"1.0.0\0".as_ptr() as *const c_char,
    create,
    destroy,
    collision: std::ptr::null(),
    membrane: std::ptr::null(),
    interaction: &FUNCTIONS.0,
});
static MODELS: Table<[*const Model; 2]> = Table([&MODEL.0, std::ptr::null()]);
static PLUGIN: Table<Plugin> =
    Table(Plugin { struct_size: size_of::<Plugin>(), abi_minor: ABI_MINOR, models: &MODELS.0 as *const *const Model });

/// The one function that the library exports.
#[no_mangle]
pub extern "C" fn rouleau_open_v1(_host_minor: u32) -> *const Plugin {
    &PLUGIN.0
}
