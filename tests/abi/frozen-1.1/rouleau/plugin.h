/* The plugin interface of Rouleau: everything a host and a model exchange, in C11 and with no other project's types.
 *
 * A plugin is a shared library that exports one function, rouleau_open_v1, beside one JSON manifest per model.
 * Rules that hold for every function below:
 *   units      lattice units unless said otherwise (length: one spacing, time: one step, density of the fluid: 1)
 *   ownership  every pointer belongs to the caller and is valid only during the call, except what open returns,
 *              which is static, and what create returns, which lives until destroy
 *   threads    open, create and destroy are called from one thread; compute functions from any number of threads at
 *              once on one `self`, which they must not change
 *   compute    no allocation, lock, I/O, exception, global variable or change of the floating-point mode
 *   shapes     [n] is an array of n numbers; [m][n] is an array of m pointers to arrays of n numbers
 *   blocks     n >= 1 elements, at any multiple of the number's own size; inputs are NULL unless the manifest's "needs"
 *              names them, outputs are NULL when the host does not want them, also those that "gives" names; inputs are
 *              read-only, and no output lies over an input unless said otherwise
 *   growth     fields are only ever appended; struct_size is the size the writer of the struct was compiled with, and
 *              a reader touches a field only if it lies within. No struct has padding at its end, where an older writer
 *              would seem to have written a field that it does not know
 *   text       UTF-8, ends with NUL */
#ifndef ROULEAU_PLUGIN_H
#define ROULEAU_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The interface's major version is in the name of the exported symbol; the minor one counts appended fields. */
#define ROULEAU_ABI_MAJOR 1
#define ROULEAU_ABI_MINOR 1
#define ROULEAU_OPEN_SYMBOL "rouleau_open_v1"

#if defined(_WIN32)
#define ROULEAU_EXPORT __declspec(dllexport)
#else
#define ROULEAU_EXPORT __attribute__((visibility("default")))
#endif

/* Kinds of model; also the manifest's "kind". */
enum { ROULEAU_COLLISION_KIND = 1, ROULEAU_MEMBRANE_KIND = 2, ROULEAU_INTERACTION_KIND = 3 };

/* What create learns about the scene and the lattice it will work on. */
typedef struct rouleau_setup {
  uint32_t struct_size;
  uint32_t host_minor; /* the host's ROULEAU_ABI_MINOR */

  /* Parameters of the manifest, all of them, in its order, within its limits, defaults filled in. A parameter with K,
   * mol or A in its unit arrives in SI, every other one in lattice units; a choice arrives as its index in the
   * manifest's list. */
  uint32_t parameter_count;           /* 0: the two arrays may be NULL */
  const char* const* parameter_names; /* [parameter_count], each NUL-terminated */
  const double* parameter_values;     /* [parameter_count] */

  /* SI value of the lattice's length (m), time (s) and mass (kg): value in SI = value here times unit. */
  double length_unit, time_unit, mass_unit;

  /* The lattice: dimension, velocity set with its weights, speed of sound squared.
   * velocities[q * dimension + k] is component k of velocity q; populations have this order everywhere. */
  uint32_t dimension, velocity_count; /* 2 and 9, or 3 and 19 */
  const double* velocities;           /* [velocity_count * dimension] */
  const double* weights;              /* [velocity_count], their sum is 1 */
  double sound_speed_squared;         /* 1/3 */

  double relaxation_rate; /* 1/tau of the suspending fluid's shear stress, in every step of this instance's life */
  uint32_t inertia;       /* 0: equilibrium and forcing without their quadratic terms (Stokes flow); else 1 */
  uint32_t reserved;      /* 0 */
} rouleau_setup;

/* ---- collision ------------------------------------------------------------------------------------------------- */

/* One chunk of consecutive lattice nodes, each computed from its own values alone. Populations are deviations from
 * rest, f_q - w_q.
 * in[q][x] and out[q'][x] may be the same memory for the same x: read all populations of a node before writing any.
 * The velocity may lie over the force in the same way. */
typedef struct rouleau_collision_block_f64 {
  uint32_t struct_size;
  uint32_t count;
  const double* const* in;       /* [velocity_count][count], before collision */
  double* const* out;            /* [velocity_count][count], after collision */
  const double* const* force;    /* [dimension][count] force density, or NULL: none */
  const double* relaxation_rate; /* [count] 1/tau of the shear stress, or NULL: that of the setup everywhere */
  double* const* velocity;       /* [dimension][count] sum f c + force/2 (reference density 1), or NULL */
} rouleau_collision_block_f64;

/* The same in single precision: a scene's "precision" decides which of the two functions is called. */
typedef struct rouleau_collision_block_f32 {
  uint32_t struct_size;
  uint32_t count;
  const float* const* in;
  float* const* out;
  const float* const* force;
  const float* relaxation_rate;
  float* const* velocity;
} rouleau_collision_block_f32;

/* Neither function is NULL. */
typedef struct rouleau_collision {
  uint32_t struct_size;
  void (*collide_f64)(const void* self, const rouleau_collision_block_f64* block);
  void (*collide_f32)(const void* self, const rouleau_collision_block_f32* block);
} rouleau_collision;

/* ---- membrane -------------------------------------------------------------------------------------------------- */

/* Elements of membranes. What one element is follows from what the manifest's "gives" names:
 *   tension             segments: element i joins node i and node i + 1
 *   moment              nodes, with the half segments on both sides
 *   pressure, perimeter_tension  whole cells
 * A law gives quantities of one element only; arrays of the other elements are NULL, and every array that is not holds
 * one value for each of the block's count elements. Curvature is turning angle over REST length, positive where the
 * outline, run through counter-clockwise, turns left. Energies are per rest length (tension, moment) or per cell. */
typedef struct rouleau_membrane_block {
  uint32_t struct_size;
  uint32_t count;
  double time_step; /* 1 in lattice units; 0: someone looks at the present state, which must stay as it is */

  const double* stretch;        /* segments: length / rest length */
  const double* stretch_rate;   /* segments: d stretch / dt */
  const double* curvature;      /* nodes */
  const double* rest_curvature; /* nodes: that of the shape the cell was created with */
  const double* area;           /* cells: enclosed area */
  const double* rest_area;
  const double* perimeter; /* cells */
  const double* rest_perimeter;

  double* tension;  /* d energy / d stretch: force along the segment, positive when it pulls its ends together */
  double* moment;   /* d energy / d curvature */
  double* pressure; /* - d energy / d area: positive pushes outward */
  double* perimeter_tension; /* d energy / d perimeter: added to the tension of every segment of the cell */
  double* energy;            /* per rest length, or per cell */

  double* tension_by_stretch; /* derivatives, for steps that are implicit */
  double* tension_by_rate;    /* not negative; if "gives" names it, the host takes tension_by_rate x rate implicitly */
  double* moment_by_curvature;

  const double* const* state; /* [states of the manifest][count], before the step; NULL if the manifest has none */
  double* const* new_state;   /* after time_step; may be the same memory element by element; NULL: not wanted */

  /* since 1.1, in three dimensions: surfaces of triangles. What one element is follows again from what the law gives:
   *   stress_1, stress_2, shear_viscosity, area_viscosity   triangles
   *   moment, area_tension                                  nodes, with the rest area that belongs to them
   *   pressure, surface_tension                             whole cells
   * With the stretches l1, l2 of a triangle against its rest shape, I1 = l1^2 + l2^2 - 2 and I2 = l1^2 l2^2 - 1.
   * Curvature is then the sum of both principal curvatures, its integral over a node's surface over REST area, positive
   * on a sphere; pressure is - d energy / d volume; arrays of segments, `area` and `perimeter` are NULL. Energies are
   * per rest area (stress, moment, area_tension) or per cell. */
  const double* invariant_1;      /* triangles: I1 */
  const double* invariant_2;      /* triangles: I2 */
  const double* invariant_1_rate; /* triangles: d I1 / dt */
  const double* invariant_2_rate; /* triangles: d I2 / dt */
  const double* area_ratio;       /* nodes: area / rest area */
  const double* volume;           /* cells: enclosed volume */
  const double* rest_volume;
  const double* surface_area; /* cells */
  const double* rest_surface_area;

  double* stress_1;        /* d energy / d I1 */
  double* stress_2;        /* d energy / d I2 */
  double* area_tension;    /* d energy / d area_ratio */
  double* surface_tension; /* d energy / d surface_area; with it pressure is - d energy / d volume */
  double* shear_viscosity; /* of the surface, not negative: taken implicitly by the host if "in_3d" names it */
  double* area_viscosity;  /* the same for dilation */

  double* stress_1_by_1; /* derivatives, for steps that are implicit: d stress_1 / d I1, ... */
  double* stress_1_by_2; /* = d stress_2 / d I1 */
  double* stress_2_by_2;
  double* area_tension_by_ratio;
} rouleau_membrane_block;

typedef struct rouleau_membrane {
  uint32_t struct_size;
  void (*compute)(const void* self, const rouleau_membrane_block* block);
} rouleau_membrane;

/* ---- interaction ----------------------------------------------------------------------------------------------- */

/* Pairs of facing surface elements of two cells: an element of one cell (a node, with the half segments on both sides)
 * and the closest place on the surface of another cell or of one of its periodic images. The host integrates over the
 * surfaces (Derjaguin), gives the force its direction and applies the reaction. Distances are positive and at most
 * cutoff.
 *
 * State belongs to the element and the other cell's image. It has its initial value when they come within the cutoff,
 * is kept while they stay there, wherever on the other surface the closest place moves, and is lost when they part.
 * Each of two facing surfaces has its own state: both count half, as their energies do. */
typedef struct rouleau_interaction_block {
  uint32_t struct_size;
  uint32_t count;
  double time_step; /* as in a membrane's block */

  const double* distance;            /* between the surfaces */
  const double* normal_velocity;     /* d distance / dt: positive when the surfaces part */
  const double* tangential_velocity; /* sliding; positive where the element runs counter-clockwise along its own cell */

  double* energy;            /* phi, per area */
  double* force;             /* - d phi / d distance, per area: positive repels */
  double* force_by_distance; /* d force / d distance */

  const double* const* state; /* [states of the manifest][count], before the step; NULL if the manifest has none */
  double* const* new_state;   /* after time_step; may be the same memory element by element; NULL: not wanted */

  /* since 1.1: magnitude of the sliding velocity, in any dimension; tangential_velocity is NULL in three */
  const double* sliding_speed;
} rouleau_interaction_block;

typedef struct rouleau_interaction {
  uint32_t struct_size;
  double (*cutoff)(const void* self); /* distance beyond which energy and force are zero; finite, not negative */
  void (*compute)(const void* self, const rouleau_interaction_block* block);
} rouleau_interaction;

/* ---- the library ----------------------------------------------------------------------------------------------- */

typedef struct rouleau_model {
  uint32_t struct_size;
  uint32_t kind;       /* ROULEAU_COLLISION_KIND, ROULEAU_MEMBRANE_KIND or ROULEAU_INTERACTION_KIND */
  const char* id;      /* the manifest's id */
  const char* version; /* the manifest's version */

  /* Makes an instance. Returns 0 and sets *self, or returns non-zero and writes one NUL-terminated sentence for the
   * user into error (error_size bytes, at least 256): also for a dimension or a velocity set that the model was not
   * made for. The setup and all it points to end with the call. Instances live side by side: each stage of a scene, and
   * each place in it that names the model, has its own. */
  int (*create)(const rouleau_setup* setup, void** self, char* error, size_t error_size);
  void (*destroy)(void* self); /* once for each instance, when no compute function runs on it any more */

  /* Exactly one is not NULL, as kind says. */
  const rouleau_collision* collision;
  const rouleau_membrane* membrane;
  const rouleau_interaction* interaction;
} rouleau_model;

typedef struct rouleau_plugin {
  uint32_t struct_size;
  uint32_t abi_minor;                 /* the plugin's ROULEAU_ABI_MINOR */
  const rouleau_model* const* models; /* ends with NULL */
} rouleau_plugin;

typedef const rouleau_plugin* (*rouleau_open_function)(uint32_t host_minor);

/* The one exported function. Returns a static table, or NULL when the plugin cannot work with this host. It may be
 * called more than once and then returns the same; a library is never unloaded. */
ROULEAU_EXPORT const rouleau_plugin* rouleau_open_v1(uint32_t host_minor);

#ifdef __cplusplus
}
#endif

#endif
