!> All groups and keys of a snapin deck with their meanings, ranges and defaults. The reader,
!> `--keys` and the resolved deck use this one table; the rows of a group are in the module that
!> reads it.
module scene_keys
  use deck_keys, only: key_spec, group, text_key
  use scene_problem, only: keys_of_model
  use cycle_groups, only: cycle_keys
  use path_groups, only: path_keys, regime_keys, profiles_keys, stability_keys
  use sensitivity_group, only: sensitivity_keys
  use rate_groups, only: rate_keys
  use theory_groups, only: theory_keys
  use sweep_group, only: sweep_keys
  use measurement_group, only: measurement_keys
  use fit_group, only: fit_keys
  use numerics_group, only: numerics_keys
  implicit none
  private
  public :: keys_of_scene

contains

  !> The table, one row for each group and key; the keys of a group follow the group.
  pure function keys_of_scene() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('scene', 'Name of the calculation.'), &
      text_key('scene', 'title', 200, 'Title, repeated in all files of results.', &
               otherwise='none'), &
      keys_of_model(), &
      cycle_keys(), &
      path_keys(), &
      sensitivity_keys(), &
      regime_keys(), &
      rate_keys(), &
      profiles_keys(), &
      theory_keys(), &
      stability_keys(), &
      measurement_keys(), &
      fit_keys(), &
      sweep_keys(), &
      numerics_keys(), &
      group('summary', 'Results in a summary file; skipped, so that the file can be run again.', &
            ignored=.true.), &
      group('cost', 'As &summary.', ignored=.true.)]
  end function keys_of_scene

end module scene_keys
