# OpenImageIO's library and headers. Debian's own package configuration names programs of other packages, and refuses to
# work without them.
find_path(ImageIO_INCLUDE OpenImageIO/imageio.h)
find_path(ImageIO_MATH_INCLUDE ImathVec.h PATH_SUFFIXES Imath)
find_library(ImageIO_LIBRARY OpenImageIO)
find_library(ImageIO_UTIL OpenImageIO_Util)
find_library(ImageIO_MATH Imath NAMES Imath Imath-3_1)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImageIO REQUIRED_VARS ImageIO_LIBRARY ImageIO_UTIL ImageIO_MATH ImageIO_INCLUDE
    ImageIO_MATH_INCLUDE)
mark_as_advanced(ImageIO_INCLUDE ImageIO_MATH_INCLUDE ImageIO_LIBRARY ImageIO_UTIL ImageIO_MATH)
if(ImageIO_FOUND AND NOT TARGET ImageIO::ImageIO)
    add_library(ImageIO::ImageIO UNKNOWN IMPORTED)
    set_target_properties(ImageIO::ImageIO PROPERTIES IMPORTED_LOCATION ${ImageIO_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES "${ImageIO_INCLUDE};${ImageIO_MATH_INCLUDE}"
        INTERFACE_LINK_LIBRARIES "${ImageIO_UTIL};${ImageIO_MATH}")
endif()
