!> Every group and key of a snapin deck: what it means, what it may be, what it is if left out.
!> The reader, `--keys` and the resolved deck all follow this one table; the rows of a group stand
!> where it is read.
module scene_keys
  use kinds, only: wp
  use deck_keys, only: key_spec, group, real_key, word_key, text_key
  use bodies_group, only: bodies_keys
  use cycle_groups, only: cycle_keys
  use path_group, only: path_keys
  use profiles_group, only: profiles_keys
  use theory_groups, only: theory_keys
  use stability_group, only: stability_keys
  use sweep_group, only: sweep_keys
  use numerics_group, only: numerics_keys
  implicit none
  private
  public :: keys_of_scene

contains

  !> The table, one row a group or key, the keys of a group right after it.
  pure function keys_of_scene() result(specs)
    type(key_spec), allocatable :: specs(:)

    specs = [ &
      group('scene', 'What the calculation is called.'), &
      text_key('scene', 'title', 200, 'Title, repeated in every file of results.', &
               otherwise='none'), &
      bodies_keys(), &
      force_keys(), &
      cycle_keys(), &
      path_keys(), &
      profiles_keys(), &
      theory_keys(), &
      stability_keys(), &
      sweep_keys(), &
      numerics_keys(), &
      group('summary', 'Results in a summary file, so that such a file can be run again.', &
            ignored=.true.), &
      group('cost', 'As &summary.', ignored=.true.)]
  end function keys_of_scene

  !> The rows of &force.
  pure function force_keys() result(specs)
    type(key_spec), allocatable :: specs(:)
    real(wp), parameter :: zero = 0

    specs = [ &
      group('force', 'Force per area between the surfaces, against their separation.', &
            required=.true.), &
      word_key('force', 'law', 'lennard_jones exponential', 'Name of the force law.', &
               required=.true.), &
      real_key('force', 'hamaker', 'J', 'lennard_jones: Hamaker constant.', above=zero, &
               otherwise='none; lennard_jones needs it'), &
      real_key('force', 'z0', 'm', 'lennard_jones: separation of zero force.', above=zero, &
               otherwise='none; lennard_jones needs it'), &
      word_key('force', 'part', 'full repulsive attractive', 'lennard_jones: the part of the ' // &
               'law that acts.', otherwise='full'), &
      real_key('force', 'p0', 'Pa', 'exponential: pressure at zero separation.', above=zero, &
               otherwise='none; exponential needs it'), &
      real_key('force', 'decay_length', 'm', 'exponential: decay length.', above=zero, &
               otherwise='none; exponential needs it')]
  end function force_keys

end module scene_keys
