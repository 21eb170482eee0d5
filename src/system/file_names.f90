!> The files that a pattern with *, ? or [...] matches, and sizes of files.
module file_names
  use, intrinsic :: iso_c_binding, only: c_char, c_long, nul => c_null_char
  use kinds, only: long
  implicit none
  private
  public :: names_like, is_pattern, bytes_of

  interface
    !> Writes the names of the files that a pattern matches into `names`, each followed by `nul`, as
    !> far as they fit. Returns the number of bytes that all of them need. The names are sorted by
    !> their bytes.
    integer(c_long) function c_names_like(pattern, names, size) bind(c, name='snapin_names_like')
      import :: c_char, c_long
      character(kind=c_char), intent(in) :: pattern(*)
      character(kind=c_char), intent(inout) :: names(*)
      integer(c_long), value :: size
    end function c_names_like

    !> Number of bytes of a file; -1 if there is no such file.
    integer(c_long) function c_bytes_of(path) bind(c, name='snapin_bytes_of')
      import :: c_char, c_long
      character(kind=c_char), intent(in) :: path(*)
    end function c_bytes_of
  end interface

contains

  !> Whether a name is a pattern.
  pure logical function is_pattern(name)
    character(len=*), intent(in) :: name

    is_pattern = scan(name, '*?[') > 0
  end function is_pattern

  !> The names of the files that a pattern matches, each followed by `nul`.
  subroutine names_like(pattern, names)
    character(len=*), intent(in) :: pattern
    character(len=:), allocatable, intent(out) :: names
    integer(c_long) :: needed

    needed = 0
    do
      allocate (character(len=needed) :: names)
      needed = c_names_like(pattern // nul, names, int(len(names), c_long))
      if (needed == len(names)) return
      ! Further files may appear between the two calls.
      deallocate (names)
    end do
  end subroutine names_like

  !> Number of bytes of a file; -1 if there is no such file.
  integer(long) function bytes_of(path)
    character(len=*), intent(in) :: path

    bytes_of = c_bytes_of(path // nul)
  end function bytes_of

end module file_names
