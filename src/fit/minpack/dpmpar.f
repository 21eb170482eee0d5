      double precision function dpmpar(i)
      integer i
c     **********
c
c     function dpmpar
c
c     machine parameters: precision, smallest and largest magnitude
c     for i = 1, 2, 3. (the original has them in data statements, one
c     set for each kind of computer.)
c
c     **********
      dpmpar = epsilon(1.0d0)
      if (i .eq. 2) dpmpar = tiny(1.0d0)
      if (i .eq. 3) dpmpar = huge(1.0d0)
      end
