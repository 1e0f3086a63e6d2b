#!/usr/bin/python3
"""Reads images of bernal with the programs they are for: tests/clients/with_vtk.py [BERNAL]

Packs a cylinder, exports it in every format of images and every kind of values, and compares what VTK (the readers of
ParaView), teem and tifffile read with the raw voxels, value by value, and their spacing, origin and unit. A program that
is not installed is left out with a word. Debian: python3-vtk9 (or python3-paraview) teem-apps python3-tifffile. Takes three seconds.
"""
from client import *

SCENE = """unit = "mm"
[container]
kind = "cylinder"
radius = 1
height = 2
base = [5, -3, 1]
axis = [0.2, 0, 1]
[spheres]
count = 100
radius = 0.1
"""


numpy = need_module("numpy", "python3-numpy")
vtk = find_module("vtk", "python3-vtk9")
tifffile = find_module("tifffile", "python3-tifffile")
unu = shutil.which("unu") or find_program("teem-unu", "teem-apps")


def near(a, b):
    return numpy.allclose(a, b, rtol=1e-9, atol=1e-12)


def read_with_vtk(reader, file, of_cells):
    from vtk.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(file))
    reader.Update()
    image = reader.GetOutput()
    data = image.GetCellData() if of_cells else image.GetPointData()
    return image, vtk_to_numpy(data.GetScalars())


def check(folder, values):
    def export(to):
        file = folder / f"{values}.{to}"
        call = [BERNAL, "export", str(folder / "out"), "--to", to, "--voxel", "0.05", "--values", values, "-o", str(file)]
        subprocess.run(call + ["--quiet"], check=True)
        return file

    header = json.loads((export("raw").with_suffix(".json")).read_text())
    voxels = numpy.fromfile(folder / f"{values}.raw", dtype=header["dtype"])
    shape = header["shape"]
    expect(voxels.size == numpy.prod(shape), f"raw {values}: {shape}")
    vti, nrrd, tiff = export("vti"), export("nrrd"), export("tiff")
    if vtk:
        image, read = read_with_vtk(vtk.vtkXMLImageDataReader(), vti, True)
        expect((read == voxels).all() and read.dtype == voxels.dtype, f"vti {values}: VTK reads the voxels")
        expect(near(image.GetSpacing(), header["spacing"]) and near(image.GetOrigin(), header["corner"]),
               f"vti {values}: spacing and corner")
        if hasattr(vtk, "vtkNrrdReader"):
            try:  # Debian's VTK reads in parallel, and wants somebody to be in charge
                from vtkmodules.vtkParallelCore import vtkDummyController
                controller = vtkDummyController()
                controller.SetGlobalController(controller)
            except ImportError:
                pass
            image, read = read_with_vtk(vtk.vtkNrrdReader(), nrrd, False)
            expect((read == voxels).all() and read.dtype == voxels.dtype, f"nrrd {values}: VTK reads the voxels")
            expect(near(image.GetSpacing(), header["spacing"]) and near(image.GetOrigin(), header["origin"]),
                   f"nrrd {values}: spacing and first centre")
    if unu:
        raw = subprocess.run([unu, "save", "-f", "nrrd", "-e", "raw", "-i", str(nrrd)], check=True, capture_output=True).stdout
        expect(raw.endswith(voxels.tobytes()), f"nrrd {values}: teem reads the voxels")
        expect(b'space units: "mm" "mm" "mm"' in raw and b"center" in raw, f"nrrd {values}: teem knows unit and centring")
    if tifffile:
        with tifffile.TiffFile(tiff) as file:
            read = file.asarray()
            about = file.imagej_metadata
            expect((read.ravel() == voxels).all() and list(read.shape) == shape, f"tiff {values}: tifffile reads the voxels")
            expect(about["unit"] == "mm" and near(about["spacing"], header["spacing"][2]), f"tiff {values}: unit and spacing")


def work(place):
    (place / "scene.toml").write_text(SCENE)
    subprocess.run([BERNAL, "pack", str(place / "scene.toml"), "-o", str(place / "out"), "--quiet"], check=True)
    for kind in ("binary", "labels", "fraction"):
        check(place, kind)


in_folder(work)
