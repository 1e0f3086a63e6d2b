# Every library that bernal uses; CONTRIBUTING.md says why each one is here.
# The Debian packages are listed in cmake/debian-packages.txt.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(NLopt 2.7 REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(assimp 5.2 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
