# spack repo create rouleau-repo; cp -r packaging/spack rouleau-repo/packages/rouleau; spack repo add rouleau-repo;
# ROULEAU_GIT=/where/the/repository/is spack install rouleau
import os

from spack.package import *


class Rouleau(CMakePackage):
    """Red blood cells that deform, flow and stick together, in two dimensions and in three."""

    git = os.environ.get("ROULEAU_GIT", "rouleau.git")
    license("MIT")

    version("main", branch="main")
    version("0.3.0", tag="v0.3.0")

    variant("mpi", default=False, description="Runs on several machines")
    variant("python", default=True, description="The Python package, and stepping from Python")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("nlohmann-json@3.11:")
    depends_on("boost@1.74: +program_options")
    depends_on("eigen@3.4:")
    depends_on("udunits")
    depends_on("hdf5~mpi")
    depends_on("libmd")
    depends_on("libpng")
    depends_on("xxhash")
    depends_on("mpi", when="+mpi")
    depends_on("py-pybind11@2.10:", type="build", when="+python")
    depends_on("py-numpy", type=("build", "run"), when="+python")
    depends_on("py-pandas", type="run", when="+python")
    depends_on("py-h5py", type="run", when="+python")

    def cmake_args(self):
        folder = f"lib/python{self.spec['python'].version.up_to(2)}/site-packages"
        return [
            self.define("BUILD_TESTING", False),
            self.define("ROULEAU_MPI", "ON" if self.spec.satisfies("+mpi") else "OFF"),
            self.define("ROULEAU_PYTHON", "ON" if self.spec.satisfies("+python") else "OFF"),
            self.define("ROULEAU_PYTHON_FOLDER", folder),
        ]

    def setup_run_environment(self, env):
        version = self.spec["python"].version.up_to(2)
        env.prepend_path("PYTHONPATH", join_path(self.prefix.lib, f"python{version}", "site-packages"))
