!> What the user should know of a run before it begins: that it will be long, or that it does not
!> fit into the memory.
module preflight
  use kinds, only: wp
  use scene_groups, only: scene_t
  use text, only: brief
  use forecast, only: forecast_t, forecast_of
  use memory, only: available_memory
  use blas_threads, only: thread_count, blas_buffers
  use progress, only: duration
  implicit none
  private
  public :: preflight_t, preflight_of

  !> Texts of one line, empty where there is nothing to say.
  type :: preflight_t
    !> Why a run cannot be begun, with the memory that it needs.
    character(len=:), allocatable :: too_large
    !> How long it may take.
    character(len=:), allocatable :: long
  end type preflight_t

  !> Seconds beyond which a run is announced as long.
  real(wp), parameter :: long_run = 30

contains

  function preflight_of(scene) result(outlook)
    type(scene_t), intent(in) :: scene
    type(preflight_t) :: outlook
    type(forecast_t) :: expected
    real(wp) :: available

    expected = forecast_of(scene, thread_count())
    available = available_memory(blas_buffers(expected%nodes, expected%copies))
    outlook%too_large = ''
    outlook%long = ''
    if (expected%bytes > available) then
      outlook%too_large = 'not computed: matrices for '//brief(real(expected%nodes, wp))// &
        ' nodes need '//gigabytes(expected%bytes)//' of memory, and '//gigabytes(available)// &
        ' are available'
    else if (expected%seconds > long_run) then
      outlook%long = brief(real(expected%nodes, wp))//' nodes: may take '// &
        duration(expected%seconds)//' or so'
      if (expected%states > 0) outlook%long = brief(expected%states)//' states on '//outlook%long
    end if
  end function preflight_of

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
