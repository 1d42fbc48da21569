"""A recipe for Spack. Copy it to packages/ductile/package.py in a Spack repository of yours, replace `git` by the
place of your clone, and run `spack install ductile`; or `spack dev-build --source-path CLONE ductile@main`."""

from spack.package import *


class Ductile(CMakePackage):
    """Anisotropic mesh adaptation of triangles and tetrahedra, the same at any number of threads."""

    homepage = "https://example.org/ductile"
    git = "https://example.org/ductile.git"
    license("BSD-3-Clause")

    version("main", branch="main")

    variant("program", default=True, description="Build the program, which draws with cairo")
    variant("python", default=False, description="Build the Python package")
    variant("petsc", default=False, description="Build the adaptor for PETSc's DMPlex")
    variant("shared", default=True, description="Build shared libraries")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("hwloc@2:")
    depends_on("boost+graph")
    depends_on("pugixml")
    depends_on("zlib-api")
    depends_on("cairo", when="+program")
    depends_on("python@3.9:", type=("build", "run"), when="+python")
    depends_on("py-pybind11@2.10:", type="build", when="+python")
    depends_on("py-numpy@1.20:", type=("build", "run"), when="+python")
    depends_on("petsc+mpi@3.18:", when="+petsc")
    extends("python", when="+python")

    def cmake_args(self):
        return [
            self.define("DUCTILE_BUILD_TESTS", False),
            self.define("DUCTILE_UNITE_SOURCES", True),
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("DUCTILE_BUILD_PROGRAM", "program"),
            self.define_from_variant("DUCTILE_BUILD_PYTHON", "python"),
            self.define_from_variant("DUCTILE_BUILD_PETSC", "petsc"),
        ]
