!> The values of h0 on the branches of a scene.
module h0_schedule
  use kinds, only: wp
  use experiment_request, only: request_t
  use force_law, only: force_law_t
  implicit none
  private
  public :: h0_schedule_t, path_plan, loading_plan, unloading_plan, states_planned, thinned

  !> Number of states of a path that is stepped in h0.
  integer, parameter :: path_states = 100

  !> The values of h0 of a branch, in the law's lengths; those with a profile; and samples whose
  !> errors represent those of all.
  type :: h0_schedule_t
    character(len=:), allocatable :: name
    real(wp), allocatable :: h0(:)
    logical, allocatable :: profile(:), sample(:)
    !> Whether there is one state for every h0, so that each state is known to be stable.
    logical :: unique = .false.
  end type h0_schedule_t

contains

  !> Number of equilibria of the requested cycle.
  pure integer function states_planned(request)
    class(request_t), intent(in) :: request
    real(wp) :: states

    states = 0
    if (allocated(request%loading)) then
      associate (l => request%loading)
        states = anint((l%h0_start - l%h0_end)/l%h0_step) + 1
      end associate
      if (allocated(request%unloading)) then
        associate (u => request%unloading)
          states = states + sum(anint((u%h0_end - u%from)/u%h0_step) + 1)
        end associate
      end if
    end if
    states_planned = nint(min(states, real(huge(1)/2, wp)))
  end function states_planned

  !> The plan of a path with one state for every h0; far: where it may begin, law's lengths.
  type(h0_schedule_t) function path_plan(request, law, far) result(plan)
    class(request_t), intent(in) :: request
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: far
    real(wp), allocatable :: farther(:)
    real(wp) :: start

    associate (finish => request%path%h0_end)
      if (allocated(request%path%h0_start)) then
        start = request%path%h0_start
      else
        start = max(law%separation_of(far), finish + law%length)
      end if
      allocate (farther(0))
      if (allocated(request%profile_h0)) &
        farther = law%gap_of(pack(request%profile_h0, request%profile_h0 > start))
      plan = schedule_of('path', start, finish, abs(start - finish)/path_states, request, law, &
        farther)
    end associate
    plan%unique = .true.
  end function path_plan

  !> The plan of the loading; also: further values of h0 to be included, law's lengths.
  type(h0_schedule_t) function loading_plan(request, law, also) result(plan)
    class(request_t), intent(in) :: request
    class(force_law_t), intent(in) :: law
    real(wp), intent(in), optional :: also(:)

    plan = schedule_of('loading', request%loading%h0_start, request%loading%h0_end, &
      request%loading%h0_step, request, law, also)
  end function loading_plan

  !> The plan of unloading k.
  type(h0_schedule_t) function unloading_plan(request, law, k) result(plan)
    class(request_t), intent(in) :: request
    class(force_law_t), intent(in) :: law
    integer, intent(in) :: k
    character(len=24) :: name

    ! No function of deferred length, since cases of a sweep would share it: compiler note 4.
    write (name, '(a, i0)') 'unloading_', k
    plan = schedule_of(trim(name), request%unloading%from(k), request%unloading%h0_end, &
      request%unloading%h0_step, request, law)
  end function unloading_plan

  !> The plan with only those rows from which numbers are taken: the ends, the samples, the
  !> profiles, and the rows nearest to the values `kept`.
  type(h0_schedule_t) function thinned(plan, kept)
    type(h0_schedule_t), intent(in) :: plan
    real(wp), intent(in) :: kept(:)
    logical :: stays(size(plan%h0))
    integer :: k

    stays = plan%profile .or. plan%sample
    stays(size(stays)) = .true.
    do k = 1, size(kept)
      stays(minloc(abs(plan%h0 - kept(k)), 1)) = .true.
    end do
    thinned = plan
    thinned%h0 = pack(plan%h0, stays)
    thinned%profile = pack(plan%profile, stays)
    thinned%sample = pack(plan%sample, stays)
  end function thinned

  !> Values of h0 [m] from start to finish by step, in either direction and with both ends. The h0
  !> of requested profiles and the values `also` (law's lengths) are inserted in order.
  function schedule_of(name, start, finish, step, request, law, also) result(plan)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: start, finish, step
    class(request_t), intent(in) :: request
    class(force_law_t), intent(in) :: law
    real(wp), intent(in), optional :: also(:)
    type(h0_schedule_t) :: plan
    real(wp), allocatable :: h0(:), profiles(:)
    !> A remainder of the range below this fraction of a step is due to rounding, and makes no step.
    real(wp), parameter :: remainder = 1.0e-6_wp
    real(wp) :: sense, same
    integer :: steps, i

    sense = sign(1.0_wp, finish - start)
    same = remainder*min(step, abs(finish - start))
    steps = floor(abs(finish - start)/step + remainder)
    h0 = [(start + sense*step*i, i=0, steps)]
    if (abs(h0(steps + 1) - finish) <= same) then
      h0(steps + 1) = finish
    else
      h0 = [h0, finish]
    end if
    allocate (profiles(0))
    if (allocated(request%profile_h0)) profiles = request%profile_h0
    if (present(also)) then
      do i = 1, size(also)
        call include(h0, law%separation_of(also(i)))
      end do
    end if
    do i = 1, size(profiles)
      if ((profiles(i) - start)*(profiles(i) - finish) <= 0) call include(h0, profiles(i))
    end do
    plan%name = name
    plan%h0 = law%gap_of(h0)
    plan%profile = [(any(abs(profiles - h0(i)) <= same), i=1, size(h0))]
    plan%sample = [(any(i == [1, (1 + size(h0))/2]), i=1, size(h0))]

  contains

    subroutine include(values, value)
      real(wp), allocatable, intent(inout) :: values(:)
      real(wp), intent(in) :: value
      integer :: place

      if (any(abs(values - value) <= same)) return
      place = count(sense*(values - value) < 0)
      values = [values(:place), value, values(place + 1:)]
    end subroutine include

  end function schedule_of

end module h0_schedule
