! The C library of Ductile from Fortran: see ductile.h, of which this has every function under its
! name. Vertices, facets and elements are numbered from 0 here, too. Where C takes NULL, give
! c_null_ptr; where it takes an array that may be NULL, c_loc(array). Compile this file with the
! program, and link with -lductile.
module ductile
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: DUCTILE_OK = 0, DUCTILE_FAILED = 1, DUCTILE_WRONG_INPUT = 2
  integer(c_int), parameter :: DUCTILE_VERTICES = 0, DUCTILE_RIDGES = 1, DUCTILE_FACETS = 2, &
                               DUCTILE_ELEMENTS = 3, DUCTILE_CONSERVATIVE = 16

  interface
    ! Arrays may have two dimensions, as corners(3, count) has.
    integer(c_int) function ductile_mesh_set_elements(mesh, count, corners, reference) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh, reference
      integer(c_int64_t), value :: count
      integer(c_int32_t), intent(in) :: corners(*)
    end function
    integer(c_int) function ductile_mesh_set_elements_64(mesh, count, corners, reference) bind(C)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: mesh, reference
      integer(c_int64_t), value :: count
      integer(c_int64_t), intent(in) :: corners(*)
    end function
    integer(c_int) function ductile_mesh_set_facets(mesh, count, corners, reference) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh, reference
      integer(c_int64_t), value :: count
      integer(c_int32_t), intent(in) :: corners(*)
    end function
    integer(c_int) function ductile_mesh_set_facets_64(mesh, count, corners, reference) bind(C)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: mesh, reference
      integer(c_int64_t), value :: count
      integer(c_int64_t), intent(in) :: corners(*)
    end function
    integer(c_int) function ductile_mesh_join_vertices(mesh, distance, kept) bind(C)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: mesh, kept
      real(c_double), value :: distance
    end function
    integer(c_int) function ductile_mesh_create(dimension, mesh) bind(C)
      import :: c_int, c_ptr
      integer(c_int), value :: dimension
      type(c_ptr), intent(out) :: mesh
    end function
    integer(c_int) function ductile_mesh_set_vertices(mesh, count, coordinates, reference) bind(C)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: mesh, reference
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: coordinates(*)
    end function
    integer(c_int) function ductile_mesh_require(mesh, kind, count, indices) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
      integer(c_int64_t), value :: count
      integer(c_int32_t), intent(in) :: indices(*)
    end function
    integer(c_int) function ductile_mesh_set_name(mesh, kind, reference, name) bind(C)
      import :: c_int, c_int32_t, c_char, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
      integer(c_int32_t), value :: reference
      character(kind=c_char), intent(in) :: name(*)  ! ends with c_null_char
    end function
    type(c_ptr) function ductile_mesh_name(mesh, kind, reference) bind(C)
      import :: c_int, c_int32_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
      integer(c_int32_t), value :: reference
    end function
    type(c_ptr) function ductile_mesh_name_at(mesh, i, kind, reference) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: i
      integer(c_int), intent(out) :: kind
      integer(c_int32_t), intent(out) :: reference
    end function
    integer(c_int) function ductile_mesh_read(path, mesh) bind(C)
      import :: c_int, c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)  ! ends with c_null_char
      type(c_ptr), intent(out) :: mesh
    end function
    integer(c_int) function ductile_mesh_write(mesh, path) bind(C)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: path(*)
    end function
    subroutine ductile_mesh_destroy(mesh) bind(C)
      import :: c_ptr
      type(c_ptr), value :: mesh
    end subroutine
    integer(c_int) function ductile_mesh_dimension(mesh) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh
    end function
    integer(c_int64_t) function ductile_mesh_count(mesh, kind) bind(C)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
    end function
    ! Arrays of the mesh: c_f_pointer() makes arrays of Fortran's of them.
    type(c_ptr) function ductile_mesh_coordinates(mesh) bind(C)
      import :: c_ptr
      type(c_ptr), value :: mesh
    end function
    type(c_ptr) function ductile_mesh_corners(mesh, kind) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
    end function
    type(c_ptr) function ductile_mesh_references(mesh, kind) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int), value :: kind
    end function
    type(c_ptr) function ductile_mesh_metric(mesh) bind(C)
      import :: c_ptr
      type(c_ptr), value :: mesh
    end function

    integer(c_int) function ductile_options_create(options) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), intent(out) :: options
    end function
    subroutine ductile_options_destroy(options) bind(C)
      import :: c_ptr
      type(c_ptr), value :: options
    end subroutine
    integer(c_int) function ductile_options_set(options, name, value) bind(C)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: options
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), value :: value
    end function
    integer(c_int) function ductile_options_set_surface(options, reference, surface, context) &
        bind(C)
      import :: c_int, c_int32_t, c_funptr, c_ptr
      type(c_ptr), value :: options, context
      integer(c_int32_t), value :: reference
      type(c_funptr), value :: surface
    end function
    integer(c_int) function ductile_options_set_geometry(options, geometry) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: options, geometry
    end function
    integer(c_int) function ductile_geometry_create(mesh, options, geometry) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh, options
      type(c_ptr), intent(out) :: geometry
    end function
    subroutine ductile_geometry_destroy(geometry) bind(C)
      import :: c_ptr
      type(c_ptr), value :: geometry
    end subroutine
    ! normals and references may be c_null_ptr.
    integer(c_int) function ductile_geometry_closest(geometry, count, points, reach, closest, &
        normals, references) bind(C)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: geometry, normals, references
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: points(*)
      real(c_double), value :: reach
      real(c_double), intent(out) :: closest(*)
    end function
    ! options and points may be c_null_ptr.
    integer(c_int) function ductile_signed_distance(mesh, options, reference_count, references, &
        count, points, distances) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: mesh, options, points
      integer(c_int64_t), value :: reference_count, count
      integer(c_int32_t), intent(in) :: references(*)
      real(c_double), intent(out) :: distances(*)
    end function
    integer(c_int) function ductile_cut(mesh, values, options, cut) bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: mesh, options
      real(c_double), intent(in) :: values(*)
      type(c_ptr), intent(out) :: cut
    end function
    integer(c_int) function ductile_options_set_material(options, reference, split, minus, plus) &
        bind(C)
      import :: c_int, c_int32_t, c_ptr
      type(c_ptr), value :: options
      integer(c_int32_t), value :: reference, minus, plus
      integer(c_int), value :: split
    end function
    ! Each array may be c_null_ptr.
    integer(c_int) function ductile_cut_origins(cut, vertices, weights, elements) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: cut, vertices, weights, elements
    end function
    integer(c_int) function ductile_options_set_progress(options, progress, context) bind(C)
      import :: c_int, c_funptr, c_ptr
      type(c_ptr), value :: options, context
      type(c_funptr), value :: progress
    end function

    integer(c_int) function ductile_sizes_create(dimension, sizes) bind(C)
      import :: c_int, c_ptr
      integer(c_int), value :: dimension
      type(c_ptr), intent(out) :: sizes
    end function
    subroutine ductile_sizes_destroy(sizes) bind(C)
      import :: c_ptr
      type(c_ptr), value :: sizes
    end subroutine
    integer(c_int) function ductile_sizes_set(sizes, name, value) bind(C)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: sizes
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), value :: value
    end function
    integer(c_int) function ductile_sizes_near_ball(sizes, centre, radius, size) bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: sizes
      real(c_double), intent(in) :: centre(*)
      real(c_double), value :: radius, size
    end function
    integer(c_int) function ductile_sizes_near_box(sizes, low, high, size) bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: sizes
      real(c_double), intent(in) :: low(*), high(*)
      real(c_double), value :: size
    end function
    integer(c_int) function ductile_sizes_near_curve(sizes, count, points, size) bind(C)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: sizes
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: points(*)
      real(c_double), value :: size
    end function
    integer(c_int) function ductile_sizes_near_surface(sizes, count, corners, size) bind(C)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: sizes
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: corners(*)
      real(c_double), value :: size
    end function
    integer(c_int) function ductile_sizes_on(sizes, kind, reference, size) bind(C)
      import :: c_int, c_int32_t, c_double, c_ptr
      type(c_ptr), value :: sizes
      integer(c_int), value :: kind
      integer(c_int32_t), value :: reference
      real(c_double), value :: size
    end function
    integer(c_int) function ductile_sizes_on_name(sizes, name, size) bind(C)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: sizes
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), value :: size
    end function
    integer(c_int) function ductile_sizes_at(sizes, mesh, values) bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: sizes, mesh
      real(c_double), intent(out) :: values(*)
    end function

    integer(c_int) function ductile_solution_metric(mesh, components, values, options, metric) &
        bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: mesh, options
      integer(c_int), value :: components
      real(c_double), intent(in) :: values(*)
      real(c_double), intent(out) :: metric(*)
    end function
    integer(c_int) function ductile_adapt(mesh, components, metric, options, adapted) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh, metric, options
      integer(c_int), value :: components
      type(c_ptr), intent(out) :: adapted
    end function
    integer(c_int) function ductile_adapt_to_sizes(mesh, sizes, options, adapted) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: mesh, sizes, options
      type(c_ptr), intent(out) :: adapted
    end function
    integer(c_int) function ductile_move(mesh, displacement, count, bodies, options, moved) bind(C)
      import :: c_int, c_int32_t, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: mesh, options
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: count
      integer(c_int32_t), intent(in) :: bodies(*)
      type(c_ptr), intent(out) :: moved
    end function
    ! Each array may be c_null_ptr.
    integer(c_int) function ductile_move_origins(moved, vertices, facets, elements) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: moved, vertices, facets, elements
    end function
    integer(c_int) function ductile_mesh_report(adapted, name, value) bind(C)
      import :: c_int, c_char, c_double, c_ptr
      type(c_ptr), value :: adapted
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(out) :: value
    end function
    type(c_ptr) function ductile_mesh_warning(adapted, i) bind(C)
      import :: c_int64_t, c_ptr
      type(c_ptr), value :: adapted
      integer(c_int64_t), value :: i
    end function
    integer(c_int) function ductile_transfer_create(before, after, transfer) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: before, after
      type(c_ptr), intent(out) :: transfer
    end function
    subroutine ductile_transfer_destroy(transfer) bind(C)
      import :: c_ptr
      type(c_ptr), value :: transfer
    end subroutine
    type(c_ptr) function ductile_transfer_origins(transfer, kind) bind(C)
      import :: c_int, c_ptr
      type(c_ptr), value :: transfer
      integer(c_int), value :: kind
    end function
    type(c_ptr) function ductile_transfer_hosts(transfer) bind(C)
      import :: c_ptr
      type(c_ptr), value :: transfer
    end function
    type(c_ptr) function ductile_transfer_weights(transfer) bind(C)
      import :: c_ptr
      type(c_ptr), value :: transfer
    end function
    integer(c_int) function ductile_transfer_carry(transfer, how, components, values, result) &
        bind(C)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: transfer
      integer(c_int), value :: how, components
      real(c_double), intent(in) :: values(*)
      real(c_double), intent(out) :: result(*)
    end function

    type(c_ptr) function ductile_version() bind(C)
      import :: c_ptr
    end function
    type(c_ptr) function ductile_last_error() bind(C)
      import :: c_ptr
    end function
  end interface

contains

  ! A text of C's, such as ductile_last_error(), as one of Fortran's.
  function ductile_text(text) result(string)
    type(c_ptr), intent(in) :: text
    character(len=:), allocatable :: string
    character(kind=c_char), pointer :: characters(:)
    integer :: i
    interface
      integer(c_size_t) function string_length(text) bind(C, name="strlen")
        import :: c_size_t, c_ptr
        type(c_ptr), value :: text
      end function
    end interface
    if (.not. c_associated(text)) then
      string = ""
      return
    end if
    call c_f_pointer(text, characters, [string_length(text)])
    allocate (character(len=size(characters)) :: string)
    do i = 1, size(characters)
      string(i:i) = characters(i)
    end do
  end function

end module ductile
