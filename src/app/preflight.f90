!> Checks before a run whether there is memory for its matrices and disk space for its files, and
!> whether the files would replace others that the deck reads or that no run has written. A run that
!> fails a check is not begun.
module preflight
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input, no_room
  use text, only: brief
  use deck_keys, only: text_value
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t
  use numerics_choice, only: choice_t, choose, with_fewer_nodes
  use scene_problem, only: problem_of
  use scene, only: swept_scene
  use h0_schedule, only: states_planned
  use decimal, only: longest_real
  use machine, only: available_memory, thread_count, blas_buffers
  use files, only: free_disk, same_file, file_exists
  use folder_lock, only: folder_lock_t
  use publication, only: result_files, summary_name, unfinished, check_names
  use result_folder, only: to_stream
  use case_columns, only: column_count
  implicit none
  private
  public :: check_room, check_inputs, large_results

  !> Memory of a run (compiler note 7) [bytes], without the matrices for a number of nodes that the
  !> deck gives. It includes the meshes of a path.
  real(wp), parameter :: other_bytes = 6.0e7_wp
  !> Number of matrices that a verified eigenvalue needs.
  real(wp), parameter :: eigenvalue_matrices = 5
  !> Number of cells in a row of the curve, of a profile and of a table of theories.
  integer, parameter :: of_curve = 10, of_profile = 9, of_theory = 5
  !> Approximate number of nodes of a mesh.
  real(wp), parameter :: of_mesh = 200
  !> Size of results [bytes] above which they are announced and the free disk space is checked.
  real(wp), parameter :: large = 1.0e8_wp, gigabyte = 1.0e9_wp

contains

  !> Fails if results in `folder` would replace a file that no run has written, or one that the deck
  !> reads: the deck itself, `name`, or a table. A summary may be a deck whose results go to its own
  !> folder, since the new summary contains the same deck.
  subroutine check_inputs(scene, name, folder, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name, folder
    type(failure_t), allocatable, intent(out) :: error
    integer :: i

    if (folder == to_stream) return
    call check(name, scene%deck%has_group('summary'))
    associate (deck => scene%deck)
      do i = 1, size(deck%specs)
        if (allocated(deck%values(i)%remark) .and. deck%specs(i)%kind == text_value) &
          call check(deck%path_of(trim(deck%specs(i)%group), trim(deck%specs(i)%key)), .false.)
      end do
    end associate
    if (.not. allocated(error)) call check_target(name, folder, error)

  contains

    subroutine check(path, is_summary)
      character(len=*), intent(in) :: path
      logical, intent(in) :: is_summary
      integer :: k

      do k = 1, size(result_files)
        if (is_summary .and. result_files(k) == summary_name) cycle
        if (same_file(path, folder // '/' // trim(result_files(k))) .or. &
          same_file(path, folder // '/' // unfinished // '/' // trim(result_files(k)))) &
          call fail(error, bad_input, name // ': results would replace ' // path // &
          ', which the deck reads; rename it, or choose another folder')
      end do
    end subroutine check

  end subroutine check_inputs

  !> Fails if something in `folder` has the name of a result although no run has written it. If the
  !> folder cannot be opened, the run reports this later.
  subroutine check_target(name, folder, error)
    character(len=*), intent(in) :: name, folder
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: closed
    type(folder_lock_t) :: target

    if (.not. file_exists(folder // '/.')) return
    call target%look_into(folder, closed)
    if (allocated(closed)) return
    call check_names(target, error)
    call target%release()
    if (.not. allocated(error)) return
    error%kind = bad_input
    error%message = name // ': ' // error%message
  end subroutine check_target

  !> Fails if there is not enough memory for a run, or not enough space on the disk with the folder
  !> of the results.
  subroutine check_room(scene, folder, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error
    type(scene_t) :: last
    real(wp) :: bytes, available, more
    character(len=:), allocatable :: what
    integer :: nodes, copies, most

    copies = 1
    call count_matrices(scene, bytes, nodes)
    if (allocated(scene%sweep)) then
      ! The sweep may change the mesh; its last case serves as an example.
      call swept_scene(scene, scene%sweep%names, scene%sweep%last(), last, error)
      if (.not. allocated(error)) then
        call count_matrices(last, more, most)
        bytes = max(bytes, more)
        nodes = max(nodes, most)
      else
        deallocate (error)
      end if
      copies = min(thread_count(), scene%sweep%cases())
      ! Cases whose cost is measured are computed one by one.
      if (scene%sweep%costs) copies = 1
      bytes = copies*bytes
    end if
    available = available_memory(blas_buffers(nodes, copies))
    if (bytes > available) then
      what = 'not computed: a run needs '
      if (nodes > 0) what = 'not computed: matrices for '//brief(nodes)//' nodes need '
      call fail(error, no_room, what//gigabytes(bytes)//' of memory, and '// &
        gigabytes(available)//' are available; free some, or raise the limit (ulimit -v)')
      return
    end if
    bytes = disk_bytes(scene)
    if (folder == to_stream .or. bytes <= large) return
    available = free_disk(folder)
    if (bytes > available) call fail(error, no_room, 'not computed: its results need '// &
      gigabytes(bytes)//' on the disk, and '//gigabytes(available)//' are free')
  end subroutine check_room

  !> The announcement of large results; empty if the results are not large.
  function large_results(scene) result(text)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: text

    text = ''
    if (disk_bytes(scene) > large) text = 'its results take about '// &
      gigabytes(disk_bytes(scene))//' on the disk while it runs'
  end function large_results

  !> Number of bytes that are allocated at the same time, and number of nodes of a grid that the
  !> deck gives.
  subroutine count_matrices(scene, bytes, nodes)
    type(scene_t), intent(in) :: scene
    real(wp), intent(out) :: bytes
    integer, intent(out) :: nodes
    type(problem_t) :: problem
    type(choice_t) :: chosen, other
    real(wp) :: entries, matrices

    bytes = 0
    nodes = 0
    if (.not. scene%finds_states()) return
    problem = problem_of(scene)
    if (problem%rigid) return
    chosen = choose(scene, problem)
    entries = 0
    if (chosen%is_fixed()) then
      nodes = chosen%nodes
      other = with_fewer_nodes(chosen)
      ! The kernel, the factors in use, and the factors for following a jump.
      matrices = merge(1, 3, chosen%options%mixing)
      if (scene%has_eigenvalues()) matrices = matrices + eigenvalue_matrices
      entries = matrices*real(chosen%nodes, wp)**2 + 2*real(other%nodes, wp)**2
    end if
    bytes = other_bytes + 8*entries
  end subroutine count_matrices

  !> Largest size of the files of a run [bytes]. The rows of a path are left out, since their number
  !> is not known in advance.
  pure real(wp) function disk_bytes(scene) result(bytes)
    type(scene_t), intent(in) :: scene

    if (allocated(scene%sweep)) then
      bytes = 2.0_wp*scene%sweep%cases()*row(column_count(scene))
      return
    end if
    bytes = states_planned(scene)*row(of_curve)
    if (allocated(scene%profile_h0)) then
      bytes = bytes + size(scene%profile_h0)*of_mesh*row(of_profile)
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

  !> A number of bytes as text for a message.
  function gigabytes(bytes) result(text)
    real(wp), intent(in) :: bytes
    character(len=:), allocatable :: text
    character(len=24) :: buffer

    write (buffer, '(f0.2, a)') bytes/gigabyte, ' GB'
    text = trim(buffer)
    if (text(1:1) == '.') text = '0'//text
  end function gigabytes

end module preflight
