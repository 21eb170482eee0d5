!> What is known of a run before it begins: the memory that its matrices take and the room that its
!> files take on the disk. Where there is less, it is not begun. Time is told while it runs.
module preflight
  use kinds, only: wp
  use failure, only: failure_t, fail, no_room
  use text, only: brief
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t
  use numerics_choice, only: choice_t, choose, companion
  use edge_locked, only: mesh_family_t, new_mesh_family
  use h0_range, only: range_of
  use scene_problem, only: problem_of
  use scene, only: swept_scene
  use h0_schedule, only: states_planned
  use decimal, only: longest_real
  use memory, only: available_memory
  use files, only: free_disk
  use results, only: to_stream
  use blas_threads, only: thread_count, blas_buffers
  implicit none
  private
  public :: check_room, large_results

  !> What a run with matrices needs beside them [bytes].
  real(wp), parameter :: other_bytes = 1.0e7_wp
  !> Matrices of a verified eigenvalue.
  real(wp), parameter :: eigenvalue_matrices = 5
  !> Cells of a row of the curve, of a profile, of a table of theories and of a sweep; bytes of a
  !> step that is kept so that an interrupted run can go on.
  integer, parameter :: of_curve = 10, of_profile = 7, of_theory = 5, of_case = 60, kept = 900
  !> Nodes of a mesh, roughly.
  real(wp), parameter :: of_mesh = 200
  !> Results that are announced, and for which there has to be room before they are begun [bytes].
  real(wp), parameter :: large = 1.0e8_wp

contains

  !> Fails where a run, whose results go into a folder, has not the room that it needs.
  subroutine check_room(scene, folder, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error
    type(scene_t) :: last
    real(wp) :: bytes, available, more
    integer :: nodes, copies, most

    copies = 1
    call count_matrices(scene, bytes, nodes)
    if (allocated(scene%sweep)) then
      ! A sweep may be over what the mesh depends on: its last case stands for that.
      call swept_scene(scene, scene%sweep%names, scene%sweep%last(), last, error)
      if (.not. allocated(error)) then
        call count_matrices(last, more, most)
        bytes = max(bytes, more)
        nodes = max(nodes, most)
      else
        deallocate (error)
      end if
      copies = min(thread_count(), scene%sweep%cases())
      bytes = copies*bytes
    end if
    available = available_memory(blas_buffers(nodes, copies))
    if (bytes > available) then
      call fail(error, no_room, 'not computed: matrices for '//brief(real(nodes, wp))// &
        ' nodes need '//gigabytes(bytes)//' of memory, and '//gigabytes(available)// &
        ' are available')
      return
    end if
    bytes = disk_bytes(scene)
    if (folder == to_stream .or. bytes <= large) return
    available = free_disk(folder)
    if (bytes > available) call fail(error, no_room, 'not computed: its results need '// &
      gigabytes(bytes)//' on the disk, and '//gigabytes(available)//' are free')
  end subroutine check_room

  !> What to say of results that take much of a disk; empty of others.
  function large_results(scene) result(text)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: text

    text = ''
    if (disk_bytes(scene) > large) text = 'its results take about '// &
      gigabytes(disk_bytes(scene))//' on the disk while it runs'
  end function large_results

  !> Bytes of the matrices that are held at once, and nodes of the largest mesh.
  subroutine count_matrices(scene, bytes, nodes)
    type(scene_t), intent(in) :: scene
    real(wp), intent(out) :: bytes
    integer, intent(out) :: nodes
    type(problem_t) :: problem
    type(choice_t) :: chosen, other
    type(mesh_family_t) :: meshes
    real(wp) :: low, high, entries, matrices

    bytes = 0
    nodes = 0
    if (.not. scene%finds_states()) return
    problem = problem_of(scene)
    if (problem%rigid) return
    call range_of(scene, problem, low, high)
    chosen = choose(scene%numerics, problem, low, allocated(scene%profiles))
    entries = 0
    if (allocated(scene%path) .or. .not. chosen%is_fixed()) then
      meshes = new_mesh_family(problem, high, low, chosen%digits, shape_only=.true.)
      nodes = maxval(meshes%grid%nodes)
      ! Kernels, one factorisation and another for a fold, and about half as much again on the finer
      ! meshes of the error estimate, which are held beside them.
      entries = 2.6_wp*sum(real(meshes%grid%nodes, wp)**2) + 3.6_wp*real(nodes, wp)**2
      if (scene%has_eigenvalues()) entries = entries + eigenvalue_matrices*real(nodes, wp)**2
    end if
    if (chosen%is_fixed()) then
      nodes = max(nodes, chosen%nodes)
      other = companion(chosen)
      ! The kernel, the factors in use, and those with which a jump is followed.
      matrices = merge(1, 3, chosen%options%mixing)
      if (scene%has_eigenvalues()) matrices = matrices + eigenvalue_matrices
      entries = max(entries, matrices*real(chosen%nodes, wp)**2 + 2*real(other%nodes, wp)**2)
    end if
    bytes = other_bytes + 8*entries
  end subroutine count_matrices

  !> Bytes that the files of a run have at most, but for rows of a path, which nobody knows before.
  pure real(wp) function disk_bytes(scene) result(bytes)
    type(scene_t), intent(in) :: scene

    if (allocated(scene%sweep)) then
      bytes = 2.0_wp*scene%sweep%cases()*row(of_case)
      return
    end if
    bytes = states_planned(scene)*(row(of_curve) + kept)
    if (allocated(scene%profiles)) then
      bytes = bytes + size(scene%profiles%h0)*of_mesh*row(of_profile)
    end if
    if (allocated(scene%classical)) bytes = bytes + &
      count(scene%classical%shown)*real(scene%classical%count, wp)*row(of_theory)
    if (allocated(scene%approximations)) &
      bytes = bytes + 4.0_wp*scene%approximations%count*row(of_theory)

  contains

    pure real(wp) function row(cells)
      integer, intent(in) :: cells

      row = real(cells, wp)*(longest_real + 1)
    end function row

  end function disk_bytes

  !> Bytes for a message.
  function gigabytes(bytes) result(text)
    real(wp), intent(in) :: bytes
    character(len=:), allocatable :: text
    character(len=24) :: buffer

    write (buffer, '(f0.2, a)') bytes/1.0e9_wp, ' GB'
    text = trim(buffer)
    if (text(1:1) == '.') text = '0'//text
  end function gigabytes

end module preflight
