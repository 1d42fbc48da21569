! A mesh from arrays, adapted to sizes at its vertices and to sizes by places: Fortran with the module that comes with libductile.
program adapt
  use ductile
  implicit none
  real(c_double) :: points(2, 4) = reshape([0, 0, 1, 0, 1, 1, 0, 1] * 1d0, [2, 4])
  integer(c_int32_t) :: triangles(3, 2) = reshape([0, 1, 2, 0, 2, 3], [3, 2])
  real(c_double), target :: sizes(4) = [.02d0, .1d0, .1d0, .02d0]
  real(c_double), pointer :: x(:, :)
  type(c_ptr) :: mesh, adapted, options, places
  integer(c_int64_t) :: vertices

  call check(ductile_mesh_create(2, mesh))
  call check(ductile_mesh_set_vertices(mesh, 4_c_int64_t, points, c_null_ptr))
  call check(ductile_mesh_set_elements(mesh, 2_c_int64_t, triangles, c_null_ptr))
  call check(ductile_options_create(options))
  call check(ductile_options_set(options, "hgrad"//c_null_char, 1.3d0))
  call check(ductile_adapt(mesh, 1, c_loc(sizes), options, adapted))

  vertices = ductile_mesh_count(adapted, DUCTILE_VERTICES)
  call c_f_pointer(ductile_mesh_coordinates(adapted), x, [2_c_int64_t, vertices])
  print '(i0, a, f5.3, a, f5.3)', vertices, " vertices, from x = ", minval(x(1, :)), " to ", &
    maxval(x(1, :))
  if (ductile_options_set(options, "hgard"//c_null_char, 1.3d0) /= DUCTILE_WRONG_INPUT) error stop 1
  print '(a)', "as expected: "//ductile_text(ductile_last_error())

  ! ---- Sizes by places: on the boundary, all of which has reference 0, and around a disc ----
  call ductile_mesh_destroy(adapted)
  call check(ductile_mesh_set_name(mesh, DUCTILE_FACETS, 0_c_int32_t, "wall"//c_null_char))
  call check(ductile_sizes_create(2, places))
  call check(ductile_sizes_set(places, "default"//c_null_char, .2d0))
  call check(ductile_sizes_near_ball(places, [.5d0, .5d0], .1d0, .02d0))
  call check(ductile_sizes_on_name(places, "wall"//c_null_char, .1d0))
  call check(ductile_adapt_to_sizes(mesh, places, options, adapted))
  print '(i0, a)', ductile_mesh_count(adapted, DUCTILE_VERTICES), " vertices, most of them in the disc"

  call ductile_sizes_destroy(places)
  call ductile_options_destroy(options)
  call ductile_mesh_destroy(adapted)
  call ductile_mesh_destroy(mesh)

contains

  subroutine check(code)
    integer(c_int), intent(in) :: code
    if (code == DUCTILE_OK) return
    print '(a)', ductile_text(ductile_last_error())
    error stop 2
  end subroutine

end program adapt
