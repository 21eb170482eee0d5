!> Errors of numbers that are read from the path, from what finer meshes say of the same.
module reading_numbers
  use kinds, only: wp
  use curve_states, only: curve_state_t, reading_t, reading_of
  use error_estimate, only: rounding
  implicit none
  private
  public :: error_of, state_errors

contains

  !> The error of a number: its difference from that of the finer meshes, raised by the margin; as
  !> large as itself where these have none.
  pure real(wp) function error_of(margin, own, fine) result(error)
    real(wp), intent(in) :: margin, own
    real(wp), intent(in), optional :: fine

    error = abs(own)
    if (present(fine)) error = margin*abs(own - fine) + rounding*abs(own)
  end function error_of

  !> The errors of what is reported of a state, in the units of `dimensionless_problem`.
  pure type(reading_t) function state_errors(margin, state) result(errors)
    real(wp), intent(in) :: margin
    type(curve_state_t), intent(in) :: state

    associate (own => reading_of(state))
      errors = reading_t(max(abs(own%h0), 1.0_wp), abs(own%load), max(abs(own%displacement), &
        1.0_wp), own%radius)
      if (.not. allocated(state%fine)) return
      errors = reading_t(error_of(margin, own%h0, state%fine%h0), &
        error_of(margin, own%load, state%fine%load), &
        error_of(margin, own%displacement, state%fine%displacement), &
        error_of(margin, own%radius, state%fine%radius))
    end associate
  end function state_errors

end module reading_numbers
