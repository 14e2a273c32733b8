# OpenSubdiv's CPU library and headers. Debian's own package configuration names a static library that it does not ship.
find_path(OpenSubdivFar_INCLUDE opensubdiv/far/patchTable.h)
find_library(OpenSubdivFar_CPU osdCPU)
find_library(OpenSubdivFar_GPU osdGPU)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdivFar REQUIRED_VARS OpenSubdivFar_CPU OpenSubdivFar_GPU OpenSubdivFar_INCLUDE)
mark_as_advanced(OpenSubdivFar_INCLUDE OpenSubdivFar_CPU OpenSubdivFar_GPU)
if(OpenSubdivFar_FOUND AND NOT TARGET OpenSubdivFar::OpenSubdivFar)
    add_library(OpenSubdivFar::OpenSubdivFar UNKNOWN IMPORTED)
    set_target_properties(OpenSubdivFar::OpenSubdivFar PROPERTIES
        IMPORTED_LOCATION ${OpenSubdivFar_CPU} INTERFACE_INCLUDE_DIRECTORIES ${OpenSubdivFar_INCLUDE})
    # Only the build's own tool that writes OpenSubdiv's GLSL text needs this one.
    add_library(OpenSubdivFar::ShaderSource UNKNOWN IMPORTED)
    set_target_properties(OpenSubdivFar::ShaderSource PROPERTIES IMPORTED_LOCATION ${OpenSubdivFar_GPU}
        INTERFACE_INCLUDE_DIRECTORIES ${OpenSubdivFar_INCLUDE} INTERFACE_LINK_LIBRARIES OpenSubdivFar::OpenSubdivFar)
endif()
